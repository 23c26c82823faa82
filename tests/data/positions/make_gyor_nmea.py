"""Writes gyor.nmea: the fixes of sample_data/gyor/gyor_q3_00.trip.csv as NMEA 0183, written by GPSBabel.

    make_gyor_nmea.py ROOT        needs gpsbabel
"""

import csv
import datetime
import pathlib
import subprocess
import sys
import tempfile

FIRST = datetime.datetime(2026, 3, 1, 8, 0, 0, tzinfo=datetime.timezone.utc)  # of t_s = 0; invented


def main():
    root = pathlib.Path(sys.argv[1])
    lines = [line for line in (root / "sample_data/gyor/gyor_q3_00.trip.csv").read_text().splitlines()
             if not line.startswith("#")]
    points = []
    for row in csv.DictReader(lines):
        if row["lat_deg"] and row["gnss_speed_mps"]:
            time = FIRST + datetime.timedelta(seconds=float(row["t_s"]))
            points.append(f'<trkpt lat="{row["lat_deg"]}" lon="{row["lon_deg"]}">'
                          f'<time>{time.strftime("%Y-%m-%dT%H:%M:%S.%f")[:-3]}Z</time>'
                          f'<course>{row["course_deg"] or 0}</course><speed>{row["gnss_speed_mps"]}</speed>'
                          f'<fix>3d</fix><hdop>1.0</hdop></trkpt>')
    with tempfile.NamedTemporaryFile("w", suffix=".gpx") as gpx:
        gpx.write('<gpx version="1.0" xmlns="http://www.topografix.com/GPX/1/0"><trk><trkseg>'
                  + "\n".join(points) + "</trkseg></trk></gpx>")
        gpx.flush()
        out = root / "tests/data/positions/gyor.nmea"
        subprocess.run(["gpsbabel", "-i", "gpx", "-f", gpx.name, "-o", "nmea,gpvtg=1", "-F", out], check=True)


main()
