"""A recording of a known program, for tests of what may be wrong with one."""
import json

import harness

PROGRAM = harness.ROOT / "examples/programs/prismatic_part.dmi"
CORNER = {"x": 700, "y": 400, "z": -550}   # of the part of that program, machine coordinates
RADIUS = 2.0                               # of its tip
TARGET = ("tx", "ty", "tz", "nx", "ny", "nz")


class Input(harness.Case):
    def setUp(self):
        super().setUp()
        self.abbe("record", PROGRAM, "-o", "rec.csv", "--with", "probe.tip_radius:amplitude_um=4")
        self.recording = self.folder / "rec.csv"

    def said(self, *args, code=0):
        return json.loads(self.abbe("diagnose", *args, "--format", "json", code=code).stdout)

    def codes(self, said):
        return [m["code"] for m in said["messages"]]

    def without(self, row, *columns):
        return {k: v for k, v in row.items() if k not in columns}

    def moved(self, by, name="moved.csv"):
        """The recording with every position passed through `by`, a function of (x, y, z)."""
        def change(row):
            place = by(*(float(row[a]) for a in "xyz"))
            return row | {a: f"{v:.7f}" for a, v in zip("xyz", place)}
        return self.changed(self.recording, change, name)
