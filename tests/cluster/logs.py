"""Trip logs to import, and what a file makes of them."""

import gzip
import re


class Logs:
    """The trips of a fleet under many names, which make them as many trips, in a folder of their own."""

    def __init__(self, trial, name, fleet):
        self.trial, self.name, self.fleet = trial, name, fleet
        self.folder = trial.folder / f"{name}-logs"
        self.folder.mkdir(exist_ok=True)
        self.texts = [gzip.decompress(file.read_bytes()) for file in fleet.logs]
        self.files = {}  # by trip_id

    def copy(self, number):
        """Trip with this number. Returns its trip_id and its file."""
        trip_id = f"copy-{number}"
        if trip_id not in self.files:
            named = re.sub(rb"(?m)^# trip_id: .*$", f"# trip_id: {trip_id}".encode(),
                           self.texts[number % len(self.texts)], count=1)
            self.files[trip_id] = self.folder / f"{trip_id}.trip.csv.gz"
            self.files[trip_id].write_bytes(gzip.compress(named, 1, mtime=0))
        return trip_id, self.files[trip_id]

    def stored(self):
        """trip_id of each trip in the database of this name."""
        connection = self.trial.cluster.connect(self.name)
        with connection.cursor() as cursor:
            cursor.execute("SELECT trip_id FROM macadam.trip")
            found = [trip_id for trip_id, in cursor.fetchall()]
        connection.close()
        return found

    def breaches(self, acknowledged):
        """What is wrong, in words, with the database of this name, which acknowledged trips of these trip_ids."""
        found = self.stored()
        lost = acknowledged - set(found)
        wrong = [f"{len(lost)} imported trips are lost"] if lost else []
        if len(set(found)) != len(found):
            wrong.append("a trip is there twice")
        logs = [str(self.files[trip_id]) for trip_id in found]
        self.trial.macadam("import", self.trial.cluster.address(self.name), *logs, "--quiet")  # fuses what an end cut short
        if self.trial.digest(self.name) != self.digest_of_file(logs):
            wrong.append("the digest is not that of the same imports into a file")
        return wrong

    def digest_of_file(self, logs):
        file = self.trial.new_file(f"{self.name}-replay", self.fleet)
        self.trial.macadam("import", str(file), *logs, "--quiet")
        return self.trial.macadam("info", str(file), "--digest").strip()
