"""Our port of the OGC's abstract tests to a running server: Features Part 1 (OGC 17-069r4, annex A), Part 2 (18-058r1, annex A)
and Tiles Part 1 (20-057, annex A), with the numbers of those that the OGC's own suites number. It tells what these tests would ask; it certifies nothing.

    ogc_abstract_tests.py PROGRAM SAMPLE_DATA     MACADAM_WEB_DATABASE names a database to serve instead of a simulated one
"""

import datetime
import http.client
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.parse

REL = "http://www.opengis.net/def/rel/ogc/1.0/"
CRS84 = "http://www.opengis.net/def/crs/OGC/1.3/CRS84"
EPSG_4326 = "http://www.opengis.net/def/crs/EPSG/0/4326"
EPSG_3857 = "http://www.opengis.net/def/crs/EPSG/0/3857"
GEOJSON = "application/geo+json"


class Server:
    """The program, serving a small simulated fleet."""

    def __init__(self, program, sample_data, folder):
        def run(*words):
            subprocess.run([program, *map(str, words)], check=True, capture_output=True, timeout=100)

        self.database = pathlib.Path(os.environ.get("MACADAM_WEB_DATABASE", folder / "roads.gpkg"))
        if not self.database.exists():
            fleet = sample_data / "fleet"
            run("simulate", "-o", folder / "fleet", "--network", fleet / "network.osm.pbf", "--recipe", fleet / "recipe.toml", "--trips", "1")
            run("init", self.database, "--network", folder / "fleet/network.osm.pbf")
            run("import", self.database, folder / "fleet/trips")
        way = json.loads(subprocess.run([program, "query", self.database, "--bbox", "-180,-90,180,90", "--json"], check=True,
                                        capture_output=True, timeout=60).stdout)[0]["way_id"]
        sections = folder / "sections.csv"
        sections.write_text(f"section,way_id\nfirst,{way}\n")
        self.process = subprocess.Popen([program, "serve", self.database, "--listen", "127.0.0.1:0", "--sections", sections],
                                        stderr=subprocess.PIPE, text=True)
        for line in self.process.stderr:
            if found := re.search(r"serving on http://([\d.]+):(\d+)/", line):
                self.host, self.port = found[1], int(found[2])
                break
        while self.get("/tiles.json")[0] == 503:
            time.sleep(0.1)

    @property
    def base(self):
        return f"http://{self.host}:{self.port}"

    def get(self, target, method="GET", **headers):
        """Status, headers in lower case, body."""
        connection = http.client.HTTPConnection(self.host, self.port, timeout=30)
        connection.request(method, target.removeprefix(self.base), headers={name.replace("_", "-"): value for name, value in headers.items()})
        response = connection.getresponse()
        answer = response.status, {name.lower(): value for name, value in response.getheaders()}, response.read()
        connection.close()
        return answer

    def close(self):
        self.process.terminate()
        self.process.wait(20)


server = None


class Case(unittest.TestCase):
    def page(self, target, media_type=None):
        status, headers, body = server.get(target, Accept="application/json")
        self.assertEqual(status, 200, f"{target}: {body[:300]}")
        if media_type:
            self.assertEqual(headers["content-type"].split(";")[0], media_type)
        return json.loads(body)

    def status(self, target, expected):
        status, _, body = server.get(target)
        self.assertEqual(status, expected, f"{target}: {body[:300]}")

    def links(self, page, rel):
        return [link for link in page["links"] if link["rel"] == rel]

    def follow(self, page, rel, media_type=None):
        found = [link for link in self.links(page, rel) if not media_type or link["type"].startswith(media_type)]
        self.assertTrue(found, f"no link {rel}")
        return self.page(found[0]["href"])

    def collections(self):
        collections = self.page("/collections")["collections"]
        self.assertEqual([each["id"] for each in collections], ["segments", "sections", "worst", "events"])
        return collections

    def items(self, collection, **parameters):
        query = urllib.parse.urlencode(parameters)
        return self.page(f"/collections/{collection['id']}/items" + (f"?{query}" if query else ""), GEOJSON)

    def parameter(self, name):
        api = self.page("/api")
        found = [each for each in api["paths"]["/collections/{collectionId}/items"]["get"]["parameters"] if each["name"] == name]
        self.assertEqual(len(found), 1, name)
        return found[0]


def positions(geometry):
    def flat(coordinates):
        if isinstance(coordinates[0], (int, float)):
            yield coordinates
        else:
            for each in coordinates:
                yield from flat(each)
    return list(flat(geometry["coordinates"])) if geometry else []


class FeaturesCore(Case):
    """OGC 17-069r4, A.2: /conf/core."""

    def test_01_http(self):
        status, headers, _ = server.get("/")
        self.assertEqual(status, 200)
        self.assertIn("content-type", headers)
        self.assertEqual(server.get("/", method="HEAD")[2], b"")

    def test_02_crs84(self):
        for collection in self.collections():
            for west, south, east, north in collection["extent"]["spatial"]["bbox"]:
                self.assertTrue(-180 <= west <= east <= 180 and -90 <= south <= north <= 90)
            for feature in self.items(collection)["features"]:
                for lon, lat, *_ in positions(feature["geometry"]):
                    self.assertTrue(west - 0.01 <= lon <= east + 0.01 and south - 0.01 <= lat <= north + 0.01, feature["id"])

    def test_03_04_landing_page(self):
        page = self.page("/", "application/json")
        for rel in ("service-desc", "conformance", "data"):
            self.assertTrue(self.links(page, rel), rel)
        self.assertTrue(self.links(page, "service-desc") or self.links(page, "service-doc"))

    def test_05_06_api_definition(self):
        link = self.links(self.page("/"), "service-desc")[0]
        status, headers, body = server.get(link["href"])
        self.assertEqual((status, headers["content-type"]), (200, link["type"]))
        self.assertRegex(json.loads(body)["openapi"], r"^3\.0\.")

    def test_07_08_conformance(self):
        classes = self.follow(self.page("/"), "conformance")["conformsTo"]
        for name in ("core", "oas30", "geojson", "html"):
            self.assertIn(f"http://www.opengis.net/spec/ogcapi-features-1/1.0/conf/{name}", classes)

    def test_09_10_collections(self):
        page = self.page("/collections", "application/json")
        self.assertTrue(self.links(page, "self") and self.links(page, "alternate"))
        for collection in page["collections"]:
            for link in self.links(collection, "items"):
                self.assertIn("type", link)
            self.assertIn(GEOJSON, [link["type"] for link in self.links(collection, "items")])
            self.assertTrue(collection["extent"]["spatial"]["bbox"])
            self.assertEqual(len(collection["extent"]["temporal"]["interval"][0]), 2)

    def test_11_12_collection(self):
        for collection in self.collections():
            self.assertEqual(self.page(f"/collections/{collection['id']}"), collection)
        self.status("/collections/none", 404)

    def test_13_22_features(self):
        for collection in self.collections():
            page = self.items(collection)
            self.assertEqual(page["type"], "FeatureCollection")
            self.assertIsInstance(page["features"], list)
            for feature in page["features"]:
                self.assertEqual((feature["type"], type(feature["id"])), ("Feature", str))
                self.assertIn("geometry", feature)
                self.assertIsInstance(feature["properties"], dict)
        self.assertTrue(self.items(self.collections()[0])["features"])

    def test_14_bbox_definition(self):
        bbox = self.parameter("bbox")
        self.assertEqual((bbox["in"], bbox["required"], bbox["style"], bbox["explode"]), ("query", False, "form", False))
        self.assertEqual(bbox["schema"]["type"], "array")
        self.assertEqual([(each["minItems"], each["maxItems"]) for each in bbox["schema"]["oneOf"]], [(4, 4), (6, 6)])
        self.assertEqual(bbox["schema"]["items"]["type"], "number")

    def test_15_bbox_response(self):
        for collection in self.collections():
            whole = self.items(collection, limit=10000)["features"]
            west, south, east, north = collection["extent"]["spatial"]["bbox"][0]
            half = [west, south, (west + east) / 2, north]
            found = {feature["id"] for feature in self.items(collection, limit=10000, bbox=",".join(map(str, half)))["features"]}
            for feature in whole:
                places = positions(feature["geometry"])
                if any(half[0] < lon < half[2] and half[1] < lat < half[3] for lon, lat, *_ in places):
                    self.assertIn(feature["id"], found)
                if all(lon > half[2] + 0.01 for lon, lat, *_ in places):
                    self.assertNotIn(feature["id"], found)
            self.assertEqual(self.items(collection, bbox="-1,-1,-0.9,-0.9")["numberMatched"], 0)

    def test_16_limit_definition(self):
        limit = self.parameter("limit")
        self.assertEqual((limit["in"], limit["required"]), ("query", False))
        self.assertEqual(limit["schema"]["type"], "integer")
        self.assertLessEqual(limit["schema"]["minimum"], limit["schema"]["default"])
        self.assertLessEqual(limit["schema"]["default"], limit["schema"]["maximum"])

    def test_17_limit_response(self):
        for collection in self.collections():
            most = self.items(collection, limit=10000)["numberReturned"]
            for limit in (1, 5, most + 10):
                self.assertEqual(len(self.items(collection, limit=limit)["features"]), min(limit, most))
            self.assertEqual(self.items(collection, limit=1_000_000)["numberReturned"], min(most, 10_000))

    def test_18_time_definition(self):
        moment = self.parameter("datetime")
        self.assertEqual((moment["in"], moment["required"], moment["schema"]["type"]), ("query", False, "string"))

    def test_19_time_response(self):
        for collection in self.collections():
            first, last = collection["extent"]["temporal"]["interval"][0]
            self.assertTrue(first and last)
            every = self.items(collection)["numberMatched"]
            for period in (f"{first}/{last}", f"../{last}", f"{first}/..", f"/{last}", f"{first}/"):
                self.assertLessEqual(self.items(collection, datetime=period)["numberMatched"], every)
            self.assertEqual(self.items(collection, datetime="../1999-12-31T23:59:59Z")["numberMatched"], 0)
            before = datetime.datetime.fromisoformat(first.replace("Z", "+00:00")) - datetime.timedelta(days=9)
            self.assertEqual(self.items(collection, datetime=before.strftime("%Y-%m-%dT%H:%M:%SZ"))["numberMatched"], 0)

    def test_20_unknown_parameter(self):
        for path in ("/", "/collections", "/collections/segments", "/collections/segments/items"):
            self.status(f"{path}?unknownQueryParameter=1", 400)

    def test_21_invalid_parameter(self):
        for query in ("limit=0", "limit=-1", "limit=x", "bbox=1,2,3", "bbox=1,2,3,north", "datetime=yesterday", "datetime=2026-13-01",
                      "datetime=2026-05-02/2026-05-01"):
            self.status(f"/collections/segments/items?{query}", 400)

    def test_23_links(self):
        for collection in self.collections():
            page = self.items(collection, limit=1)
            self.assertTrue(self.links(page, "self") and self.links(page, "alternate"))
            self.assertTrue(all(link["rel"] and link["type"] for link in page["links"]))
            self.assertEqual(bool(self.links(page, "next")), page["numberMatched"] > 1)

    def test_24_time_stamp(self):
        for collection in self.collections():
            page = self.items(collection)
            if "timeStamp" in page:  # optional
                datetime.datetime.fromisoformat(page["timeStamp"].replace("Z", "+00:00"))

    def test_25_26_numbers(self):
        for collection in self.collections():
            page = self.items(collection, limit=50)
            self.assertEqual(page["numberReturned"], len(page["features"]))
            ids = []
            while True:
                ids += [feature["id"] for feature in page["features"]]
                if not (following := self.links(page, "next")):
                    break
                page = self.page(following[0]["href"])
            self.assertEqual(len(ids), page["numberMatched"])
            self.assertEqual(len(set(ids)), len(ids))

    def test_27_28_feature(self):
        for collection in self.collections():
            for feature in self.items(collection, limit=3)["features"]:
                one = self.page(f"/collections/{collection['id']}/items/{urllib.parse.quote(feature['id'], safe='')}", GEOJSON)
                for rel in ("self", "collection"):
                    self.assertTrue(self.links(one, rel), rel)
                self.assertEqual({name: one[name] for name in feature}, feature)
        self.status("/collections/segments/items/none", 404)


class FeaturesEncodings(Case):
    """OGC 17-069r4, A.3 geojson, A.5 html, A.6 oas30."""

    def test_geojson(self):
        for target in ("/collections/segments/items", "/collections/segments/items?f=json"):
            self.assertEqual(server.get(target, Accept=GEOJSON)[1]["content-type"], GEOJSON)

    def test_html(self):
        for target in ("/", "/conformance", "/collections", "/collections/segments", "/collections/segments/items"):
            status, headers, body = server.get(f"{target}{'&' if '?' in target else '?'}f=html")
            self.assertEqual((status, headers["content-type"].split(";")[0]), (200, "text/html"))
            self.assertTrue(body.startswith(b"<!DOCTYPE html>"))

    def test_oas30_definition_names_every_path(self):
        paths = self.page("/api")["paths"]
        for path in ("/", "/conformance", "/collections", "/collections/{collectionId}", "/collections/{collectionId}/items",
                     "/collections/{collectionId}/items/{featureId}"):
            self.assertIn("200", paths[path]["get"]["responses"])
            self.assertTrue(paths[path]["get"]["operationId"])

    def test_oas30_security(self):
        for path, operations in self.page("/api")["paths"].items():
            for operation in operations.values():
                if "security" in operation:
                    self.assertIn("401", operation["responses"], path)


class FeaturesCrs(Case):
    """OGC 18-058r1, A.2: /conf/crs."""

    def test_01_crs_uri(self):
        for collection in self.collections():
            for uri in collection["crs"]:
                self.assertRegex(uri, r"^http://www\.opengis\.net/def/crs/[A-Z]+/[\d.]+/\w+$")

    def test_default_crs_and_storage_crs(self):
        for collection in self.collections():
            self.assertEqual(collection["crs"][0], CRS84)
            self.assertIn(collection["storageCrs"], collection["crs"])

    def feature(self, **parameters):
        status, headers, body = server.get("/collections/segments/items?" + urllib.parse.urlencode({"limit": 1, **parameters}))
        self.assertEqual(status, 200, body[:300])
        return json.loads(body)["features"][0], headers["content-crs"]

    def test_crs_parameter(self):
        plain, header = self.feature()
        self.assertEqual(header, f"<{CRS84}>")
        lon, lat = positions(plain["geometry"])[0]
        for crs, expected in ((CRS84, (lon, lat)), (EPSG_4326, (lat, lon)),
                              (EPSG_3857, (6378137 * math.radians(lon), 6378137 * math.asinh(math.tan(math.radians(lat)))))):
            feature, header = self.feature(crs=crs)
            self.assertEqual(header, f"<{crs}>")
            for found, wanted in zip(positions(feature["geometry"])[0], expected):
                self.assertAlmostEqual(found, wanted, delta=0.02 if crs == EPSG_3857 else 1e-7)  # 7 decimals of a degree are 1 cm
            one = f"/collections/segments/items/{urllib.parse.quote(feature['id'], safe='')}?crs={urllib.parse.quote(crs, safe='')}"
            status, headers, _ = server.get(one)
            self.assertEqual((status, headers["content-crs"]), (200, f"<{crs}>"))

    def test_invalid_crs(self):
        first = self.feature()[0]["id"]
        for target in ("/collections/segments/items", f"/collections/segments/items/{urllib.parse.quote(first, safe='')}"):
            self.status(f"{target}?crs=http%3A%2F%2Fwww.opengis.net%2Fdef%2Fcrs%2FEPSG%2F0%2F99999", 400)

    def test_bbox_crs(self):
        west, south, east, north = self.collections()[0]["extent"]["spatial"]["bbox"][0]
        east = (west + east) / 2
        x, y = (lambda lon: 6378137 * math.radians(lon)), (lambda lat: 6378137 * math.asinh(math.tan(math.radians(lat))))
        expected = self.items({"id": "segments"}, bbox=f"{west},{south},{east},{north}")["numberMatched"]
        self.assertTrue(expected)
        for crs, box in ((CRS84, (west, south, east, north)), (EPSG_4326, (south, west, north, east)),
                         (EPSG_3857, (x(west), y(south), x(east), y(north)))):
            page = self.items({"id": "segments"}, **{"bbox": ",".join(f"{each:.9f}" for each in box), "bbox-crs": crs})
            self.assertEqual(page["numberMatched"], expected, crs)

    def test_invalid_bbox_crs(self):
        self.status("/collections/segments/items?bbox=1,2,3,4&bbox-crs=http%3A%2F%2Fwww.opengis.net%2Fdef%2Fcrs%2F0%2Funknown", 400)


class Tiles(Case):
    """OGC 20-057, annex A: core, tileset, tilesets-list, dataset-tilesets, geodata-tilesets, mvt, png."""

    def sets(self):
        landing = self.page("/")
        found = [link for link in landing["links"] if link["rel"].startswith(f"{REL}tilesets-")]
        self.assertEqual({link["rel"] for link in found}, {f"{REL}tilesets-vector", f"{REL}tilesets-map"})
        return [(link["href"], self.page(link["href"])) for link in found]

    def templates(self):
        for _, page in self.sets():
            for tileset in page["tilesets"]:
                yield tileset, [link for link in tileset["links"] if link["rel"] == "item"][0]

    def tile(self, template, zoom, row, column):
        return server.get(template.replace("{tileMatrix}", str(zoom)).replace("{tileRow}", str(row)).replace("{tileCol}", str(column)))

    def test_http(self):
        for href, _ in self.sets():
            self.assertEqual(server.get(href)[0], 200)

    def test_a02_tiles_are_available(self):
        self.assertEqual(len(list(self.templates())), 2)

    def test_a03_a04_a05_template_parameters(self):
        for _, link in self.templates():
            self.assertTrue(link["templated"])
            for name in ("{tileMatrix}", "{tileRow}", "{tileCol}"):
                self.assertIn(name, link["href"])

    def test_a06_success(self):
        shown = 0
        for tileset, link in self.templates():
            (west, south), (east, north) = tileset["boundingBox"]["lowerLeft"], tileset["boundingBox"]["upperRight"]
            for zoom in (0, 8, 12, 14):
                side = 2 ** zoom
                column = int(((west + east) / 2 + 180) / 360 * side)
                row = int((1 - math.asinh(math.tan(math.radians((south + north) / 2))) / math.pi) / 2 * side)
                status, headers, body = self.tile(link["href"], zoom, row, column)
                self.assertIn(status, (200, 204))
                if status == 200:
                    self.assertEqual(headers["content-type"], link["type"])
                    self.assertTrue(body.startswith(b"\x89PNG") if link["type"] == "image/png" else len(body) > 0)
                    shown += 1
        self.assertGreaterEqual(shown, 4)

    def test_a07_error(self):
        for _, link in self.templates():
            for zoom, row, column in ((0, 1, 0), (0, 0, 1), (99, 0, 0), (5, 32, 0), (5, -1, 0), (5, 0, "x")):
                self.assertIn(self.tile(link["href"], zoom, row, column)[0], (400, 404))

    def test_tileset_links(self):
        for _, page in self.sets():
            for tileset in page["tilesets"]:
                self.assertTrue(self.links(tileset, "self") and self.links(tileset, f"{REL}tiling-scheme"))

    def test_tileset_metadata(self):
        for _, page in self.sets():
            for tileset in page["tilesets"]:
                whole = self.follow(tileset, "self")
                self.assertIn(whole["dataType"], ("vector", "map"))
                self.assertEqual(whole["crs"], EPSG_3857)
                self.assertEqual(whole["tileMatrixSetURI"], "http://www.opengis.net/def/tilematrixset/OGC/1.0/WebMercatorQuad")

    def test_tilesets_lists(self):
        for href, page in self.sets():
            self.assertEqual(self.links(page, "self")[0]["href"], href)
            self.assertTrue(page["tilesets"])

    def test_a10_landing_page_of_dataset_tilesets(self):
        self.assertEqual({urllib.parse.urlparse(href).path for href, _ in self.sets()}, {"/tiles", "/map/tiles"})

    def test_a12_links_of_geodata_tilesets(self):
        segments = self.collections()[0]
        self.assertEqual(self.follow(segments, f"{REL}tilesets-vector")["tilesets"][0]["dataType"], "vector")

    def test_tile_matrix_set(self):
        listed = self.follow(self.page("/"), f"{REL}tiling-schemes")["tileMatrixSets"]
        whole = self.page(listed[0]["links"][0]["href"])
        for zoom, matrix in enumerate(whole["tileMatrices"]):
            self.assertEqual((matrix["id"], matrix["matrixWidth"], matrix["matrixHeight"]), (str(zoom), 2 ** zoom, 2 ** zoom))
            self.assertAlmostEqual(matrix["scaleDenominator"] / (559082264.0287178 / 2 ** zoom), 1, places=9)

    def test_conformance(self):
        classes = self.page("/conformance")["conformsTo"]
        for name in ("core", "tileset", "tilesets-list", "dataset-tilesets", "geodata-tilesets", "mvt", "png"):
            self.assertIn(f"http://www.opengis.net/spec/ogcapi-tiles-1/1.0/conf/{name}", classes)

    def test_openapi_of_tiles(self):
        names = {operation["operationId"] for operations in self.page("/api")["paths"].values() for operation in operations.values()}
        for name in ("dataset.vector.getTileSetsList", "dataset.vector.getTileSet", "dataset.vector.getTile", "dataset.map.getTile",
                     "segments.vector.getTile"):
            self.assertIn(name, names)


def main(program, sample_data):
    global server
    with tempfile.TemporaryDirectory() as folder:
        server = Server(program, pathlib.Path(sample_data), pathlib.Path(folder))
        try:
            suite = unittest.defaultTestLoader.loadTestsFromModule(sys.modules[__name__])
            if suite.countTestCases() < 40:
                sys.exit("tests are missing")
            result = unittest.TextTestRunner(verbosity=1).run(suite)
        finally:
            server.close()
    print(f"passes {result.testsRun - len(result.failures) - len(result.errors)} of {result.testsRun} tests of our port")
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
