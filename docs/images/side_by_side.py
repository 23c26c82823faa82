"""Draw the same roads with QGIS and Mapnik, and count what their maps name.

    macadam export roads.gpkg -o all.gpkg --all
    QT_QPA_PLATFORM=offscreen /usr/bin/python3 side_by_side.py all.gpkg W,S,E,N OUTPUT_FOLDER qgis|mapnik

Debian's python3-qgis and python3-mapnik. Both draw 800 x 600 pixels at 96 dpi in Web Mercator, and
both are told to name every road along its line, merged by name, which neither does by itself.
"""

import math
import sqlite3
import sys


def mercator(lon_deg, lat_deg):
    radius_m = 6378137.0
    lat = math.radians(lat_deg)
    return radius_m * math.radians(lon_deg), radius_m * math.log(math.tan(math.pi / 4 + lat / 2))


def frame(box, width, height):
    """The box of that shape around the middle of a box of degrees."""
    west, south = mercator(box[0], box[1])
    east, north = mercator(box[2], box[3])
    scale = max((east - west) / width, (north - south) / height)
    x, y = (west + east) / 2, (south + north) / 2
    return x - scale * width / 2, y - scale * height / 2, x + scale * width / 2, y + scale * height / 2


WIDTH, HEIGHT = 800, 600
data, box, folder = sys.argv[1], [float(text) for text in sys.argv[2].split(",")], sys.argv[3]
extent = frame(box, WIDTH, HEIGHT)


def with_qgis():
    from qgis.core import (QgsApplication, QgsCoordinateReferenceSystem, QgsMapRendererParallelJob,
                           QgsMapSettings, QgsPalLayerSettings, QgsRectangle, QgsTextFormat,
                           QgsTextBufferSettings, QgsVectorLayer, QgsVectorLayerSimpleLabeling)
    from PyQt5.QtCore import QSize
    from PyQt5.QtGui import QColor, QFont
    application = QgsApplication([], False)
    application.initQgis()
    layer = QgsVectorLayer(data + "|layername=roughness", "roughness", "ogr")
    labels = QgsPalLayerSettings()
    labels.fieldName = "name"
    labels.placement = QgsPalLayerSettings.Curved
    labels.lineSettings().setMergeLines(True)
    text = QgsTextFormat()
    text.setFont(QFont("Noto Sans"))
    text.setSize(7.7)
    halo = QgsTextBufferSettings()
    halo.setEnabled(True)
    halo.setSize(0.4)
    halo.setColor(QColor("#f4f4f2"))
    text.setBuffer(halo)
    labels.setFormat(text)
    layer.setLabeling(QgsVectorLayerSimpleLabeling(labels))
    layer.setLabelsEnabled(True)
    settings = QgsMapSettings()
    settings.setLayers([layer])
    settings.setDestinationCrs(QgsCoordinateReferenceSystem("EPSG:3857"))
    settings.setExtent(QgsRectangle(*extent))
    settings.setOutputSize(QSize(WIDTH, HEIGHT))
    settings.setOutputDpi(96)
    settings.setBackgroundColor(QColor("#f4f4f2"))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    job.renderedImage().save(folder + "/maps-qgis.png")
    labels = job.takeLabelingResults().allLabels()  # a part for each letter
    print("QGIS:", len({label.labelText for label in labels}), "names,",
          len({(label.labelText, label.featureId) for label in labels}), "labels")


def with_mapnik():
    import mapnik
    from osgeo import gdal
    merged = folder + "/names.gpkg"
    gdal.VectorTranslate(merged, data, SQLDialect="SQLite", layerName="names", SQLStatement=(
        "SELECT name, ST_LineMerge(ST_Collect(geom)) AS geom FROM roughness "
        "WHERE name <> '' AND direction = 'forward' GROUP BY name"))
    colours = sqlite3.connect(data).execute("SELECT DISTINCT class FROM roughness").fetchall()
    names = {"good": "#2c7bb6", "fair": "#fee090", "poor": "#d7191c"}
    rules = "".join(
        f'<Rule><Filter>[class] = "{name}"</Filter><LineSymbolizer stroke="{names[name]}" '
        'stroke-width="3.5" stroke-linecap="round"/></Rule>'
        for (name,) in colours if name in names)
    style = f"""<Map srs="epsg:3857" background-color="#f4f4f2">
    <Style name="casing"><Rule><Filter>[iri] &gt; 0</Filter>
      <LineSymbolizer stroke="#333b43" stroke-width="5.5" stroke-linecap="round"/></Rule>
      <Rule><ElseFilter/><LineSymbolizer stroke="#b7b8b4" stroke-width="2"/></Rule></Style>
    <Style name="core">{rules}</Style>
    <Style name="names"><Rule><TextSymbolizer face-name="Noto Sans Regular" size="10" fill="#1e2328"
      halo-fill="#f4f4f2" halo-radius="1.5" placement="line" repeat-distance="420" spacing="420"
      max-char-angle-delta="18">[name]</TextSymbolizer></Rule></Style>
    <Layer name="roads" srs="epsg:4326"><StyleName>casing</StyleName><StyleName>core</StyleName>
      <Datasource><Parameter name="type">ogr</Parameter><Parameter name="file">{data}</Parameter>
      <Parameter name="layer">roughness</Parameter></Datasource></Layer>
    <Layer name="names" srs="epsg:4326"><StyleName>names</StyleName>
      <Datasource><Parameter name="type">ogr</Parameter><Parameter name="file">{merged}</Parameter>
      <Parameter name="layer">names</Parameter></Datasource></Layer></Map>"""
    sheet = mapnik.Map(WIDTH, HEIGHT)
    mapnik.FontEngine.register_font("/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf")
    mapnik.load_map_from_string(sheet, style)
    sheet.zoom_to_box(mapnik.Box2d(*extent))
    mapnik.render_to_file(sheet, folder + "/maps-mapnik.png")


{"qgis": with_qgis, "mapnik": with_mapnik}[sys.argv[4]]()
