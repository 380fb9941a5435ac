"""abbe diagnose: the lines before the table of a recording."""
import harness
from recorded_input import PROGRAM, Input


class Lines(Input):
    def with_lines(self, *lines, name="lines.csv"):
        return self.write(name, "".join(f"# {line}\n" for line in lines) + self.recording.read_text())

    def test_lines_that_contradict_each_other_are_refused(self):
        for first, second in (("surfaces: calibrated", "surfaces: unknown"), ("approach_mm: 3", "approach_mm: 4"), ("workpiece: a.json", "workpiece: b.json")):
            said = self.refused("E0532", "diagnose", self.with_lines(first, "note: free", second))
            self.assertRegex(said, rf"lines.csv:\d+:1: error E0532: .*line 1, '{first}'")
        self.refused("E0532", "diagnose", self.with_lines("machine: other"))
        self.refused("E0532", "diagnose", self.with_lines("frame: part"))
        self.refused("E0532", "run", PROGRAM, "--recording", self.with_lines("point: surface"))
        same = self.with_lines("surfaces: calibrated", "surfaces: calibrated", "approach_mm: 5.0", "note: one", "note: other")
        self.assertEqual(self.codes(self.said(same, "--design-only")), self.codes(self.said(self.recording, "--design-only")))
        values = "# machine: coord3-mc16\n# machine: other\ncharacteristic,value\nLEN,1\n"
        self.refused("E0532", "diagnose", self.write("values.csv", values), "--program", PROGRAM)

    def test_a_misspelt_key_is_doubted(self):
        text = self.recording.read_text()
        for wrong, right in (("Surfaces: unknown", "surfaces"), ("surface: unknown", "surfaces"), ("POINT: surface", "point"), ("aproach_mm: 3", "approach_mm")):
            done = self.abbe("diagnose", self.with_lines(wrong), "--design-only")
            self.assertIn("lines.csv:1:1: warning W0533", done.stderr)
            self.assertIn(f"did you mean '# {right}:'?", done.stderr)
        self.assertIn("'# sensor NAME:'", self.abbe("diagnose", self.write("lines.csv", text.replace("# sensor ", "# Sensor ")), "--design-only", code=2).stderr)
        free = self.with_lines("operator: N.N.", "Part: bracket", "sensors: 1", "speed: slow", "temperature: 20", "artefact: sphere", "note: surfaces unknown")
        self.assertNotIn("W0533", self.abbe("diagnose", free, "--design-only").stderr)
        self.assertIn("W0533", self.abbe("run", PROGRAM, "--recording", self.with_lines("Point: tip_centre"), "--machines", 20).stderr)

    def test_a_line_that_cannot_be_read_is_named_with_its_place(self):
        self.assertIn("lines.csv:2:1: error E0703", self.refused("E0703", "diagnose", self.with_lines("note: free", "surfaces: maybe")))
        said = self.refused("E0545", "diagnose", self.with_lines("note: free", "sensor H1: head_deg 0"))
        self.assertIn("lines.csv:2:1: error E0545: 'sensor H1' cannot be read: head_deg has 1 of 2 numbers", said)

    def test_the_default_machine_is_not_taken_in_silence(self):
        named = self.said(self.recording, "--design-only")
        self.assertEqual((list(named)[:2], named["machine"]), (["schema", "machine"], "coord3-mc16"))
        self.assertNotIn("N0735", self.codes(named))
        nameless = self.write("nameless.csv", self.recording.read_text().replace("# machine: coord3-mc16\n", ""))
        for options in ((), ("--design-only",)):
            said = self.said(nameless, *options)
            self.assertEqual((self.codes(said)[0], said["machine"]), ("N0735", "coord3-mc16"))
        self.assertNotIn("N0735", self.codes(self.said(nameless, "--design-only", "--machine", "coord3-mc16")))
        self.write("own.json", (harness.ROOT / "examples/machines/coord3-mc16.json").read_text().replace("coord3-mc16", "own"))
        program = self.write("own.dmi", PROGRAM.read_text().replace("machine coord3-mc16", "machine own.json"))
        of_program = self.said(nameless, "--design-only", "--program", program)
        self.assertEqual((of_program["machine"], "N0735" in self.codes(of_program)), ("own", False))

    def test_a_table_of_values_without_characteristics(self):
        values = self.write("values.csv", "value,reference\n30,30\n")
        said = self.refused("E0527", "diagnose", values, "--program", PROGRAM)
        self.assertIn("the column 'characteristic' is missing", said)
        self.assertEqual(said.count("error"), 1, said)


if __name__ == "__main__":
    harness.main()
