"""QGIS without a screen reads a server's collections by its OGC API - Features provider, and its picture tiles.

    qgis_reads_server.py PROGRAM SAMPLE_DATA     MACADAM_WEB_DATABASE names a database to serve instead of a simulated one
"""

import os
import pathlib
import sys
import tempfile

os.environ["QT_QPA_PLATFORM"] = "offscreen"
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "conformance"))

from qgis.core import QgsApplication, QgsFeatureRequest, QgsRasterLayer, QgsRectangle, QgsVectorLayer  # noqa: E402

import json  # noqa: E402

from ogc_abstract_tests import Server  # noqa: E402


def expect(found, expected, what):
    if found != expected:
        sys.exit(f"{what}: {found!r}, expected {expected!r}")


def read(server, collection):
    layer = QgsVectorLayer(f"url='{server.base}/' typename='{collection}' pagingEnabled='true' pageSize='150'", collection, "OAPIF")
    expect(layer.isValid(), True, f"QGIS opens {collection}")
    page = json.loads(server.get(f"/collections/{collection}/items?limit=10000")[2])
    features = list(layer.getFeatures())
    expect(len(features), page["numberMatched"], f"features of {collection}")
    names = {field.name() for field in layer.fields()}
    expect(set(page["features"][0]["properties"]) - names, set() if features else None, f"fields of {collection} that QGIS has not")
    return layer, features


def main(program, sample_data):
    with tempfile.TemporaryDirectory() as folder:
        os.environ["HOME"] = folder  # QGIS keeps a profile and a cache
        application = QgsApplication([], False)
        application.initQgis()
        server = Server(program, pathlib.Path(sample_data), pathlib.Path(folder))
        try:
            layer, features = read(server, "segments")
            read(server, "sections")
            read(server, "worst")
            box = layer.extent()
            half = QgsRectangle(box.xMinimum(), box.yMinimum(), box.center().x(), box.yMaximum())
            found = {feature["iri"] for feature in layer.getFeatures(QgsFeatureRequest(half))}
            if not 0 < len(found) < len({feature["iri"] for feature in features}):
                sys.exit("QGIS gets no part of the segments by a box")
            tiles = QgsRasterLayer(f"type=xyz&url={server.base}/map/tiles/WebMercatorQuad/%7Bz%7D/%7By%7D/%7Bx%7D&zmax=16&zmin=0", "pictures", "wms")
            expect(tiles.isValid(), True, "QGIS opens the picture tiles")
            print(f"QGIS reads {len(features)} segments, {len(found)} values of a half")
        finally:
            server.close()
        del layer, tiles
        application.exitQgis()


main(*sys.argv[1:])
