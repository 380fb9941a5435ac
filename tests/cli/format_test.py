#!/usr/bin/env python3
"""abbe format: on stdout, checked, written back."""
import harness
from harness import LENGTH

TIDY = LENGTH.replace("PTMEAS", "  PTMEAS")


class Format(harness.Case):
    def test_writes_to_stdout(self):
        path = self.write("a.dmi", LENGTH.lower().replace("s(p)", "s( P )"))
        out = self.abbe("format", "a.dmi").stdout
        self.assertIn("\n  PTMEAS/CART,0,0,0,-1,0,0\n", out)
        self.assertIn("S(P)=SNSDEF/PROBE,INDEX,POL,0.0", out)
        self.assertEqual(path.read_text().splitlines()[0], "dmismn/'a length',4.0")

    def test_check_names_what_differs(self):
        self.write("untidy.dmi", LENGTH)
        self.write("tidy.dmi", TIDY)
        done = self.abbe("format", "--check", "tidy.dmi", "untidy.dmi", code=1)
        self.assertIn("untidy.dmi: not formatted", done.stdout)
        self.assertNotIn("\ntidy.dmi", "\n" + done.stdout)
        self.assertEqual(self.abbe("format", "--check", "tidy.dmi").stdout, "")

    def test_write_changes_the_file_and_not_its_meaning(self):
        path = self.write("a.dmi", LENGTH)
        plan = self.abbe("check", "--plan", "a.dmi").stdout
        self.assertEqual(self.abbe("format", "--write", "a.dmi").stdout, "")
        self.assertEqual(path.read_text(), TIDY)
        self.assertEqual(self.abbe("check", "--plan", "a.dmi").stdout, plan)

    def test_folders_are_searched_for_programs(self):
        self.write("programs/a.dmi", LENGTH)
        self.write("programs/deeper/b.dmi", TIDY)
        self.assertIn("programs/a.dmi", self.abbe("format", "--check", "programs", code=1).stdout)
        self.abbe("format", "--write", "programs")
        self.assertEqual((self.folder / "programs/a.dmi").read_text(), TIDY)
        self.write("empty/note.txt", "no program")
        self.refused("E0601", "format", "empty")

    def test_expressions_stay_as_they_were_written(self):
        self.write("x.dmi", "x=assign/sqrt(2) + sin( 3 ) .and. .true.\n")
        self.assertEqual(self.abbe("format", "x.dmi").stdout, "x=ASSIGN/sqrt(2) + sin( 3 ) .and. .true.\n")

    def test_bytes_that_are_not_utf8_stay(self):
        path = self.write("latin.dmi", LENGTH.replace("F(A)", "F(\u00c4)").encode("latin-1"))
        self.abbe("format", "--write", "latin.dmi")
        self.assertIn("F(\u00c4)".encode("latin-1"), path.read_bytes())

    def test_utf16_is_refused_and_stays(self):
        path = self.write("wide.dmi", LENGTH.encode("utf-16"))
        before = path.read_bytes()
        self.refused("E0618", "format", "--write", "wide.dmi")
        self.assertEqual(path.read_bytes(), before)

    def test_wrong_usage(self):
        self.write("a.dmi", LENGTH)
        self.refused("E0609", "format", "--check", "--write", "a.dmi")
        self.refused("E0601", "format", "none.dmi")


if __name__ == "__main__":
    harness.main()
