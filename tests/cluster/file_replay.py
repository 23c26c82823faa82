"""The ledger's trips, stored anew in a GeoPackage: from the file that the templates came from, by no server."""

import sqlite3

from ledger import hash_of

DRIVES = {
    "pass": "SELECT trip.trip_id, segment.strip, coalesce(pass.drive, -1), pass.* FROM pass"
            " JOIN segment ON segment.fid = pass.segment JOIN trip ON trip.id = pass.trip",
    "trace": "SELECT trip.trip_id, trace.strip, trace.drive, trace.* FROM trace JOIN trip ON trip.id = trace.trip",
}
OF_TRIPS = ("pass", "trace", "event", "event_search", "row_reason", "state_change", "audit", "strip_state",
            "segment_state", "trip")


def drives_in(file, table):
    """Rows of a table by trip, chunk and drive, as lists whose second value is the trip's row."""
    rows = {}
    for trip_id, chunk, drive, *row in file.execute(DRIVES[table]):
        rows.setdefault((trip_id, chunk, drive), []).append(row)
    return rows


def replay(name, templates, numbers):
    """Puts trips of the ledger in the place of those of a file, as on the server. Fusion is left to the program."""
    with sqlite3.connect(name) as file:
        drives = {table: drives_in(file, table) for table in DRIVES}
        for table in OF_TRIPS:
            file.execute(f"DELETE FROM {table}")
        for row, number in enumerate(numbers, 1):
            (trip_id, *trip), parts = templates.of(number)
            file.execute(
                "INSERT INTO trip (id, sha256, trip_id, vehicle, file_name, t0_utc_ms, vehicle_model, method, distance_mm,"
                " matched_mm, rows_read, rows_used) VALUES (?, ?, ?, (SELECT min(id) FROM vehicle), ?, ?, ?, ?, ?, ?, ?, ?)",
                (row, hash_of(number), f"trip-{number}", f"trip-{number}", *trip))
            for _, chunk, drive, *_ in parts:
                for table, rows in drives.items():
                    for segment, _, *values in rows.get((trip_id, chunk, drive), []):
                        file.execute(f"INSERT INTO {table} VALUES ({', '.join('?' * (2 + len(values)))})",
                                     (segment, row, *values))
        file.execute("INSERT INTO segment_dirty SELECT DISTINCT segment FROM pass")
        file.execute("INSERT INTO strip_dirty SELECT DISTINCT strip FROM segment JOIN pass ON pass.segment = segment.fid")
