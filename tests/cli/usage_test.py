"""The command line itself: help, version, and wrong usage (exit code 2)."""
import harness


class Usage(harness.Case):
    def test_version(self):
        self.assertRegex(self.abbe("--version").stdout, r"^abbe \d+\.\d+\.\d+\n$")

    def test_help_names_the_whole_command(self):
        self.assertIn("abbe run [OPTIONS] PROGRAM", self.abbe("run", "--help").stdout)
        self.assertIn("abbe machine screen", self.abbe("machine", "screen", "--help").stdout)
        for command in ("run", "check", "test", "fit", "machine", "explain"):
            self.assertIn(f"  {command} ", self.abbe("--help").stdout)

    def test_unknown_words_get_a_suggestion(self):
        self.assertIn("'explain'", self.refused("E0609", "explian"))
        self.assertIn("'--machines'", self.refused("E0609", "run", "--machnes", "3", "x.dmi"))
        self.assertIn("'screen'", self.refused("E0609", "machine", "scren"))

    def test_what_is_missing_is_named(self):
        self.assertIn("run, check, test, fit, machine", self.refused("E0609"))
        self.assertIn("list, show, screen, init", self.refused("E0609", "machine"))
        self.assertIn("PROGRAM", self.refused("E0609", "run"))
        self.assertIn("--help", self.refused("E0609", "run"))

    def test_only_effects_have_a_figure(self):
        self.assertIn('"reading of x, mm"', self.abbe("explain", "machine.scale", "--format", "vega").stdout)
        self.assertIn("machine.scale", self.refused("E0431", "explain", "machine.scal", "--format", "vega"))
        self.assertIn("'PTMEAS' is none", self.refused("E0431", "explain", "PTMEAS", "--format", "vega"))
        self.assertIn("none is named", self.refused("E0431", "explain", "--format", "vega"))

    def test_values_that_cannot_be_read(self):
        self.assertIn("abc", self.refused("E0609", "run", "x.dmi", "--machines", "abc"))
        self.assertIn("found -1", self.refused("E0609", "run", "x.dmi", "--seed", "-1"))
        self.assertIn("xml", self.refused("E0609", "run", "x.dmi", "--format", "xml"))
        self.assertIn("1,2", self.refused("E0609", "fit", "circle", "p.csv", "--normal", "1,2"))
        self.refused("E0609", "run", "x.dmi", "y.dmi")
        self.refused("E0609", "run", "x.dmi", "--digits", "1", "--machines", "100")


harness.main()
