"""What QGIS (3.22 or later, headless) makes of exports, projects and databases.

    MACADAM_PROGRAM=build/macadam QT_QPA_PLATFORM=offscreen qgis_test.py
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile
from xml.etree import ElementTree

from qgis.core import (QgsApplication, QgsCoordinateTransform, QgsMapRendererSequentialJob, QgsMapSettings,
                       QgsProject, QgsProviderRegistry, QgsRectangle, QgsVectorLayer)
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor

SOURCE = pathlib.Path(__file__).resolve().parents[3]
TRIP = SOURCE / "sample_data/comma2k19/comma2k19_rav4.trip.csv"
QGIS = QgsApplication([], False)
CLASSES = ["good (below 1.50 mm/m)", "fair (1.50 to 2.68 mm/m)", "poor (above 2.68 mm/m)"]
US_CLASSES = ["good (below 95 in/mi)", "fair (95 to 170 in/mi)", "poor (above 170 in/mi)"]
COLOURS = {"#2c7bb6", "#fee090", "#d7191c"}


def run(*words):
    subprocess.run([os.environ["MACADAM_PROGRAM"], *map(str, words)], check=True, capture_output=True)


def colours_in(layer):
    """Colours of the picture of a layer."""
    settings = QgsMapSettings()
    settings.setLayers([layer])
    settings.setExtent(layer.extent().buffered(1e-4))
    settings.setDestinationCrs(layer.crs())
    settings.setOutputSize(QSize(400, 400))
    settings.setBackgroundColor(QColor("white"))
    job = QgsMapRendererSequentialJob(settings)
    job.start()
    job.waitForFinished()
    image = job.renderedImage()
    return {image.pixelColor(x, y).name() for x in range(image.width()) for y in range(image.height())}


class Qgis(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        QGIS.initQgis()
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.store = cls.folder / "roads.gpkg"
        run("init", cls.store, "--trace", TRIP)
        run("import", cls.store, TRIP)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def expect_style(self, layer, classes=CLASSES, field="iri", alias="IRI (mm/m)", low="iri_low"):
        self.assertTrue(layer.isValid())
        self.assertEqual(layer.renderer().type(), "graduatedSymbol")
        self.assertEqual([each.label() for each in layer.renderer().ranges()], classes)
        self.assertEqual([each.symbol().symbolLayerCount() for each in layer.renderer().ranges()], [2, 2, 2])
        self.assertEqual(layer.renderer().classAttribute(), field)
        self.assertEqual(layer.fields()[layer.fields().indexOf(field)].alias(), alias)
        self.assertIn(f'"{low}"', layer.mapTipTemplate())
        self.assertTrue(layer.labelsEnabled())
        self.assertEqual(layer.labeling().settings().fieldName, "name")

    def test_opens_exports_in_their_classes(self):
        for suffix in ("geojson", "fgb", "shp"):
            with self.subTest(suffix):
                file = self.folder / suffix / f"out.{suffix}"
                file.parent.mkdir()
                run("export", self.store, "-o", file)
                layer = QgsVectorLayer(str(file), "out", "ogr")
                self.expect_style(layer)
                self.assertTrue(COLOURS & colours_in(layer))

    def test_opens_exports_in_units_of_the_united_states(self):
        for suffix in ("geojson", "fgb", "shp", "gpkg"):
            with self.subTest(suffix):
                file = self.folder / f"us-{suffix}" / f"out.{suffix}"
                file.parent.mkdir()
                run("export", self.store, "-o", file, "--units", "us")
                layer = QgsVectorLayer(f"{file}|layername=roughness" if suffix == "gpkg" else str(file), "out", "ogr")
                field, low = ("iri_inmi", "low_inmi") if suffix == "shp" else ("iri_in_per_mi", "iri_low_in_per_mi")
                self.expect_style(layer, US_CLASSES, field, "IRI (in/mi)", low)
                self.assertTrue(COLOURS & colours_in(layer))
                aliases = " ".join(each.alias() for each in layer.fields())
                self.assertNotIn("mm/m", aliases)
                self.assertNotIn("(m ", aliases)

    def test_reads_the_sld(self):
        run("export", self.store, "-o", self.folder / "sld.geojson")
        layer = QgsVectorLayer(str(self.folder / "sld.geojson"), "sld", "ogr")
        (self.folder / "sld.qml").unlink()
        _, is_read = layer.loadSldStyle(str(self.folder / "sld.sld"))
        self.assertTrue(is_read)
        rules = layer.renderer().rootRule().children()
        self.assertEqual(len(rules), 12)  # three classes at four scales
        self.assertEqual({rule.label() for rule in rules}, set(CLASSES))
        self.assertTrue(COLOURS & colours_in(layer))

    def test_shows_the_roads_of_a_database_and_no_inner_table(self):
        offered = QgsProviderRegistry.instance().querySublayers(str(self.store))
        self.assertEqual({each.name() for each in offered}, {"segment", "roughness"})
        self.expect_style(QgsVectorLayer(f"{self.store}|layername=roughness", "roughness", "ogr"))

    def test_opens_the_project_of_a_database(self):
        project_file = self.folder / "project" / "roads.qgz"
        project_file.parent.mkdir()
        run("export", self.store, "-o", project_file)
        project = QgsProject.instance()
        self.assertTrue(project.read(str(project_file)))
        self.assertEqual(project.crs().authid(), "EPSG:3857")
        tree = [each.name() for each in project.layerTreeRoot().findLayers()]
        self.assertEqual(tree, ["Roughness (IRI in mm/m)", "OpenStreetMap"])  # the first lies on top
        roads, base = (project.mapLayersByName(name)[0] for name in tree)
        self.expect_style(roads)
        self.assertTrue(base.isValid())
        self.assertGreater(roads.featureCount(), 10)
        self.assertTrue(COLOURS & colours_in(roads))
        with zipfile.ZipFile(project_file) as archive:
            extent = ElementTree.fromstring(archive.read("roads.qgs")).find("mapcanvas/extent")
        view = QgsRectangle(*(float(extent.find(side).text) for side in ("xmin", "ymin", "xmax", "ymax")))
        to_view = QgsCoordinateTransform(roads.crs(), project.crs(), project)
        self.assertTrue(view.buffered(1).contains(to_view.transformBoundingBox(roads.extent())))
        project.clear()


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
