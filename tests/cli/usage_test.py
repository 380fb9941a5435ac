"""The command line itself: help, version, and wrong usage (exit code 2)."""
import json
import os
import pathlib
import re
import shutil
import subprocess

import harness

PART = harness.ROOT / "examples/programs/prismatic_part.dmi"


class Usage(harness.Case):
    def test_version(self):
        self.assertRegex(self.abbe("--version").stdout, r"^abbe \d+\.\d+\.\d+\n$")

    def test_help_names_the_whole_command(self):
        self.assertIn("abbe run [OPTIONS] PROGRAM", self.abbe("run", "--help").stdout)
        self.assertIn("abbe machine screen", self.abbe("machine", "screen", "--help").stdout)
        listed = self.abbe("--help").stdout.split("Subcommands:\n")[1].splitlines()
        commands = [line.split()[0] for line in listed if line.startswith("  ")]
        self.assertEqual(commands, ["run", "check", "test", "fit", "machine", "record", "diagnose", "format", "lsp", "repl", "explain"])
        for command in commands:
            self.assertIn(f"Usage: abbe {command} ", self.abbe(command, "--help").stdout)

    def test_it_is_installed_as_one_file(self):
        prefix, build = self.folder / "installed", pathlib.Path(self.abbe_path).parent
        subprocess.run(["cmake", "--install", build, "--prefix", prefix], check=True, capture_output=True)
        self.assertEqual([p.relative_to(prefix).as_posix() for p in prefix.rglob("*") if p.is_file()], ["bin/abbe"])
        self.assertIn("coord3-mc16", subprocess.run([prefix / "bin/abbe", "machine", "list"], capture_output=True, text=True).stdout)

    def test_unknown_words_get_a_suggestion(self):
        self.assertIn("'explain'", self.refused("E0609", "explian"))
        self.assertIn("'--machines'", self.refused("E0609", "run", "--machnes", "3", "x.dmi"))
        self.assertIn("'screen'", self.refused("E0609", "machine", "scren"))

    def test_what_is_missing_is_named(self):
        self.assertIn("run, check, test, fit, machine", self.refused("E0609"))
        self.assertIn("list, show, screen, init", self.refused("E0609", "machine"))
        self.assertIn("PROGRAM", self.refused("E0609", "run"))
        self.assertIn("--help", self.refused("E0609", "run"))

    def test_every_code_of_a_message_is_explained(self):
        table = (harness.ROOT / "engine/base/diagnostic_codes.def").read_text()
        kinds = {"error": "no result comes of it", "warning": "may not mean", "note": "nothing is wrong"}
        for code, severity, title in re.findall(r'^X\((\w+), (\w+), "(.*)"\)', table, re.MULTILINE):
            told = self.abbe("explain", code).stdout
            self.assertIn(f"{code}: {title}\n  about: ", told)
            self.assertIn(kinds[severity], told, code)
            self.assertIn("\n  found when ", told)
            for page, chapter in re.findall(r"(docs/\w+\.md)(?: \(\"([^\"]*)\")?", told.split("\n  read: ")[1]):
                self.assertIn(chapter, (harness.ROOT / page).read_text(), code)

    def test_a_word_in_arguments_says_in_which(self):
        told = self.abbe("explain", "mmc").stdout
        self.assertIn("MMC\n  a word in the arguments of TOL/", told)
        for statement in ("TOL/POS", "TOL/PERP"):
            self.assertIn(statement, told)
        self.assertIn("FEAT/CIRCLE", self.abbe("explain", "INNER").stdout)
        self.assertIn("x0_um, y0_um, z0_um, r0_um, x1_um, ..., r15_um [um]", self.abbe("explain", "empirical.curve").stdout)
        for no_word in ("F", "LABEL", "INNE", ",", ""):
            self.refused("E0609", "explain", no_word)

    def test_every_acceptance_test_is_explained(self):
        listed = self.abbe("explain").stdout.split("\nAcceptance tests\n")[1].split("\n\n")[0].splitlines()
        self.assertEqual(len(listed), len(list((harness.ROOT / "engine/machine/acceptance").glob("*.cpp"))) - 1)   # all.cpp is the list
        for line in listed:
            self.assertIn("source: ISO 10360-", self.abbe("explain", line[2:36].strip()).stdout)
        self.assertIn("simulated machines must pass it", self.abbe("explain", "e150").stdout)
        self.assertIn("did you mean form and size?", self.refused("E0609", "explain", "form and sizes"))

    def test_every_word_of_a_report_is_explained(self):
        self.write("length.dmi", harness.LENGTH)
        report = self.run_json("length.dmi", "--machines", 50, "--budget", "--coverage", 0.99)
        one = report["characteristics"][0]
        text = self.abbe("run", "length.dmi", "--machines", 50).stdout
        titles = [line.split() for line in text.splitlines() if line.startswith("line ")]
        self.assertEqual(len(titles), 2)
        listed = self.abbe("explain").stdout.split("\nReport\n")[1].split("\n\n")[0].split()
        for word in {*one, *one["decision"], *report["machines"], *one["contributions"], *titles[0], *titles[1], *listed}:
            self.assertIn(": a word of reports", self.abbe("explain", word).stdout, word)
        self.assertIn("standard uncertainty", self.abbe("explain", "u").stdout)
        self.assertIn("expanded uncertainty", self.abbe("explain", "U").stdout)
        self.assertIn("`lcl` in the JSON", self.abbe("explain", "LCL").stdout)
        self.assertIn("VALUE/", self.abbe("explain", "value").stdout)

    def test_every_word_of_a_diagnosis_is_explained(self):
        self.abbe("record", harness.ROOT / "examples/programs/sphere_25_points.dmi", "-o", "rec.csv")
        said = json.loads(self.abbe("diagnose", "rec.csv", "--format", "json").stdout)
        listed = self.abbe("explain").stdout.split("\nDiagnosis\n")[1].split("\n\n")[0].split()
        for word in {*said, "prob.", "detected", "form", "looks like", "gain", "log_score_gain", "geometry_scale", *listed} - {"schema", "looks", "like"}:
            self.assertIn(": a word of diagnoses", self.abbe("explain", word).stdout, word)
        self.assertIn("a word of reports", self.abbe("explain", "verdict").stdout)
        self.assertIn("cannot be told apart", self.abbe("explain", "members").stdout)
        self.assertIn("80 of 100", self.abbe("explain", "detected").stdout)   # as docs/diagnosis_method.md has it

    def test_families_and_parts_of_the_names_of_effects(self):
        self.assertIn("  head.reindexing ", self.abbe("explain", "head").stdout)
        self.assertIn("  thermal.drift ", self.abbe("explain", "thermal").stdout)
        for part, effect in (("pretravel_lobing", "probe.pretravel_lobing"), ("squarenes", "machine.squareness"), ("tip_radius", "probe.tip_radius")):
            self.assertIn(f"did you mean {effect}?", self.refused("E0609", "explain", part))
            self.assertIn(f"did you mean {effect}?", self.refused("E0431", "explain", part, "--format", "vega"))

    def test_a_file_of_another_kind_is_named_once(self):
        self.write("length.dmi", harness.LENGTH)
        self.abbe("record", "length.dmi", "-o", "rec.csv", "--dmo", "length.dmo")
        self.abbe("run", "length.dmi", "--machines", 20, "--csv", "values.csv")
        self.write("result.txt", (self.folder / "length.dmo").read_text())
        self.write("bare.csv", "feature,touch,x,y,z\nA,1,0,0,0\n")
        machine = harness.ROOT / "examples/machines/coord3-mc16.json"
        for file, what, readers in (
                ("rec.csv", "a table", ("run", "check", "test", "format", "machine show", "record -o x.csv", "run length.dmi --workpiece")),
                ("bare.csv", "a table", ("run", "machine screen", "diagnose rec.csv --program", "run length.dmi --machine")),
                ("values.csv", "a table", ("run", "check")),
                ("length.dmo", "a DMIS result file", ("run", "check", "machine show", "fit circle")),
                ("result.txt", "a DMIS result file", ("diagnose", "run length.dmi --recording")),
                (machine, "a JSON file", ("run", "check", "test", "format", "diagnose", "fit circle", "run length.dmi --recording")),
                ("length.dmi", "a DMIS program", ("machine show", "diagnose", "fit circle", "diagnose rec.csv --known", "run length.dmi --recording", "run length.dmi --workpiece"))):
            for reader in readers:
                said = self.refused("E0622", *reader.split(), file)
                self.assertIn(f"is {what}", said)
                self.assertEqual(said.count("error"), 1, said)
        self.write("results.txt", "FA(A)=FEAT/POINT,CART,0,0,0,1,0,0\nENDFIL\n")
        self.assertIn("is a DMIS result file; what is expected here is a table (CSV), as recordings are\n", self.refused("E0622", "diagnose", "results.txt"))
        self.assertIn("`abbe diagnose` reads recordings", self.refused("E0622", "run", "rec.csv"))

    def test_only_effects_have_a_figure(self):
        self.assertIn('"reading of x, mm"', self.abbe("explain", "machine.scale", "--format", "vega").stdout)
        self.assertIn("machine.scale", self.refused("E0431", "explain", "machine.scal", "--format", "vega"))
        self.assertIn("'PTMEAS' is none", self.refused("E0431", "explain", "PTMEAS", "--format", "vega"))
        self.assertIn("none is named", self.refused("E0431", "explain", "--format", "vega"))

    def test_the_whole_reference_is_asked_for_alone(self):
        for also in (("PTMEAS",), ("machine.scale", "--format", "vega")):
            self.assertIn("--markdown", self.refused("E0609", "explain", *also, "--markdown"))

    def test_numbers_are_decimals(self):
        self.write("length.dmi", harness.LENGTH)
        said = self.run_json("length.dmi", "--machines", "010", "--seed", "+08")
        self.assertEqual((said["machines"]["used"], said["seed"]), (10, 8))

    def test_a_result_that_cannot_be_written_is_said(self):
        self.write("length.dmi", harness.LENGTH)
        for command in (("check", "length.dmi"), ("check", "length.dmi", "--plan"), ("check", "length.dmi", "--format", "json"), ("explain",), ("explain", "--markdown"),
                        ("explain", "PTMEAS"), ("fit", "circle", harness.ROOT / "tests/cli/circle.csv"), ("machine", "list"), ("--help",)):
            with open("/dev/full", "w") as full:
                self.assertIn("E0602", self.abbe(*command, code=2, stdout=full).stderr, command)

    def test_without_the_result_no_file_is_written(self):
        self.write("length.dmi", "$$! expect TA(LEN) u >= 0\n" + harness.LENGTH)
        self.abbe("record", PART, "-o", "rec.csv")
        commands = ("run length.dmi --machines 20 --csv out --report out2", "diagnose rec.csv --machine coord3-mc16 --design-only --report out",
                    "test length.dmi --machines 20 --junit out")
        for command in commands:
            for stdout in (">/dev/full", ">&-", "| true"):
                done = subprocess.run(["bash", "-o", "pipefail", "-c", f"{self.abbe_path} {command} {stdout}"], cwd=self.folder, capture_output=True, text=True)
                if stdout != "| true":   # a pipe may take it all before its reader is gone
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertIn("E0602", done.stderr)
                if done.returncode:
                    self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["length.dmi", "rec.csv"], command + stdout)
                for made in self.folder.glob("out*"):
                    made.unlink()

    def test_json_is_alone_on_stdout(self):
        self.write("length.dmi", harness.LENGTH)
        self.abbe("record", PART, "-o", "rec.csv")
        diagnose = ("diagnose", "rec.csv", "--machine", "coord3-mc16", "--design-only", "--format", "json")
        self.refused("E0616", *diagnose, "--report", "/dev/stdout")
        self.refused("E0616", "run", "length.dmi", "--machines", 20, "--format", "json", "--csv", "/dev/stdout")
        with open(self.folder / "out.json", "w") as out:
            self.abbe(*diagnose, "--report", "out.json", code=2, stdout=out)
        self.abbe("run", "length.dmi", "--machines", 20, "--csv", "/dev/stdout")
        with open("/dev/null", "w") as nowhere:
            self.abbe(*diagnose, "--report", "/dev/null", stdout=nowhere)

    def test_a_limit_of_the_file_size_leaves_nothing_half(self):
        self.write("length.dmi", harness.LENGTH)
        done = subprocess.run(["bash", "-c", f"ulimit -f 4; {self.abbe_path} run length.dmi --machines 1000 --csv values.csv"], cwd=self.folder,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("E0602", done.stderr)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["length.dmi"])

    def test_what_cannot_even_be_looked_for_is_not_there(self):
        """A name that is too long, a link that leads round in a circle."""
        self.write("parts/length.dmi", "$$! expect TA(LEN) u >= 0\n" + harness.LENGTH)
        self.abbe("record", PART, "-o", "rec.csv")
        self.write("other.csv", re.sub("(?m)^# machine: .*", "# machine: " + 300 * "m", (self.folder / "rec.csv").read_text()))
        self.write("values.csv", f"characteristic,program,value\nLEN,{300 * 'p'},100.001\n")
        for round_about in ("parts/circle.dmi", "circle"):
            (self.folder / round_about).symlink_to(pathlib.Path(round_about).name)
        self.refused("E0411", "run", PART, "--machine", 300 * "m")
        self.refused("E0411", "diagnose", "other.csv")
        self.refused("E0601", "diagnose", "values.csv")
        self.refused("E0602", "machine", "init", 300 * "m" + ".json")
        self.refused("E0602", "run", PART, "--csv", "circle")
        for command in ("check", "test", "format"):
            self.abbe(command, "parts")
        self.assertTrue((self.folder / "circle").is_symlink())

    def test_a_page_is_utf8_whatever_its_files_are_called(self):
        program, recording = (os.fsencode(self.folder) + b"/\xff<b>\xc3\xa9" + ending for ending in (b".dmi", b".csv"))
        shutil.copy(PART, program)
        self.abbe("record", PART, "-o", "rec.csv")
        shutil.copy(self.folder / "rec.csv", recording)
        for command in (("run", program, "--machines", "5"), ("diagnose", recording, "--design-only")):
            subprocess.run([self.abbe_path, *command, "--report", "page.html"], cwd=self.folder, capture_output=True, check=True)
            self.assertIn("\ufffd&lt;b&gt;\u00e9", (self.folder / "page.html").read_text(encoding="utf-8"))

    def test_the_folder_of_an_output_is_tried_before_the_work(self):
        self.write("length.dmi", harness.LENGTH)
        (self.folder / "locked").mkdir(mode=0o555)
        user = {"user": 65534, "extra_groups": []} if os.geteuid() == 0 else {}   # root may write anywhere
        self.folder.chmod(0o755)
        done = subprocess.run([self.abbe_path, "run", "length.dmi", "--machines", "5", "--csv", "locked/values.csv"], cwd=self.folder, capture_output=True,
                              text=True, **user)
        self.assertEqual(done.returncode, 2)
        self.assertIn("E0602", done.stderr)
        self.assertNotIn("W0435", done.stderr)   # what a run has to say

    def test_a_folder_that_is_gone_is_no_fault(self):
        self.write("length.dmi", harness.LENGTH)
        done = subprocess.run(["bash", "-c", f"mkdir gone; cd gone; rmdir ../gone; {self.abbe_path} run {self.folder}/length.dmi --machines 20 --csv {self.folder}/values.csv"],
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((self.folder / "values.csv").exists())

    def test_what_a_directive_names_is_refused_at_its_place(self):
        self.write("length.dmi", "$$! machine nope\n" + harness.LENGTH)
        self.assertIn("length.dmi:1:13: error E0411", self.refused("E0411", "run", "length.dmi"))

    def test_a_hyphen_is_no_output(self):
        self.write("length.dmi", harness.LENGTH)
        self.abbe("record", "length.dmi", "-o", "rec.csv")
        diagnose = ("diagnose", "rec.csv", "--machine", "coord3-mc16")
        run, record = ("run", "length.dmi", "--machines", 20), ("record", "length.dmi")
        for command in ((*record, "-o", "-"), (*record, "-o", "r.csv", "--dmo", "-"), (*run, "--csv", "-"), (*run, "--dmo", "-"), (*run, "--report", "-"),
                        (*diagnose, "--report", "-"), (*diagnose, "--model-out", "-"), ("test", "length.dmi", "--junit", "-")):
            self.assertIn("/dev/stdout", self.refused("E0602", *command))
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["length.dmi", "rec.csv"])
        self.assertTrue(self.abbe("record", "length.dmi", "-o", "/dev/stdout").stdout.endswith((self.folder / "rec.csv").read_text()[-100:]))

    def test_values_that_cannot_be_read(self):
        self.assertIn("abc", self.refused("E0609", "run", "x.dmi", "--machines", "abc"))
        self.assertIn("found -1", self.refused("E0609", "run", "x.dmi", "--seed", "-1"))
        for number in ("0x64", "1e3", "12.5", "99999999999999999999999", "3 4", ""):
            self.assertIn(f"found {number}", self.refused("E0609", "run", "x.dmi", "--seed", number))
            self.assertIn("a whole number from 2 to 2147483647", self.refused("E0609", "run", "x.dmi", "--machines", number))
        self.assertIn("from 1 to 2,", self.refused("E0609", "run", "x.dmi", "--digits", "two"))
        self.assertIn("from 0 to 256,", self.refused("E0609", "run", "x.dmi", "--threads", "all"))
        self.assertIn("from 1 to 2147483647,", self.refused("E0609", "machine", "screen", "coord3-mc16", "--machines", "x"))
        for number in ("0x1p-1", "nan", "inf", "95%"):
            self.assertIn(f"from 0 to 1, found {number}", self.refused("E0609", "run", "x.dmi", "--coverage", number))
        self.assertIn("from 1 to", self.refused("E0609", "record", "x.dmi", "-o", "r.csv", "--run", "0"))
        self.assertIn("xml", self.refused("E0609", "run", "x.dmi", "--format", "xml"))
        self.assertIn("1,2", self.refused("E0609", "fit", "circle", "p.csv", "--normal", "1,2"))
        self.refused("E0609", "run", "x.dmi", "y.dmi")
        self.refused("E0609", "run", "x.dmi", "--digits", "1", "--machines", "100")


harness.main()
