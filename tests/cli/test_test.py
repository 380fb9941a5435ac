"""abbe test: expectations, what they are about, JUnit."""
import xml.etree.ElementTree as ElementTree

import harness
from harness import LENGTH


class Expectations(harness.Case):
    def program(self, *expectations, name="length.dmi", text=LENGTH):
        lines = [f"$$! expect {e}\n" for e in expectations]
        return self.write(name, "$$! machines 100\n" + "".join(lines) + text)

    def test_all_quantities(self):
        self.program("TA(LEN) u between 0.0002 0.005", "TA(LEN) u95 between 0.0004 0.01", "TA(LEN) lcl <= 0", "TA(LEN) ucl >= 0",
                     "TA(LEN) mean between 99.99 100.01", "TA(LEN) value between 99.999999 100.000001", "TA(LEN) conformance >= 0.9",
                     "FA(B) TA(len) u >= 0", "accepted between 0.2 0.6")
        done = self.abbe("test", "length.dmi")
        self.assertEqual(done.stdout.splitlines()[-1], "9 passed, 0 failed")
        self.assertEqual([line[:2] for line in done.stdout.splitlines()[:-1]], ["ok"] * 9)
        self.assertIn("length.dmi:2: TA(LEN) u = ", done.stdout)

    def test_u95_is_half_the_symmetric_interval(self):
        self.write("plain.dmi", LENGTH)
        low, high = self.run_json("plain.dmi", "--machines", 100)["characteristics"][0]["interval95"]["symmetric"]
        half = (high - low) / 2
        self.program(f"TA(LEN) u95 between {half * 0.999999:.12f} {half * 1.000001:.12f}")
        self.abbe("test", "length.dmi")

    def test_every_evaluation_of_the_tolerance_is_tested(self):
        twice = LENGTH.replace("ENDFIL", "F(C)=FEAT/POINT,CART,400,0,0,1,0,0\nMEAS/POINT,F(C),1\nPTMEAS/CART,400,0,0,1,0,0\nENDMES\nOUTPUT/FA(A),FA(C),TA(LEN)\nENDFIL")
        self.program("TA(LEN) u <= 1", "TA(LEN) value <= 399", "FA(B) TA(LEN) value <= 399", text=twice)
        lines = self.abbe("test", "length.dmi", code=1).stdout.splitlines()
        self.assertTrue(lines[0].endswith("is <= 1 (the first of 2; all are)"), lines[0])
        self.assertTrue(lines[1].startswith("FAIL"), lines[1])
        self.assertTrue(lines[2].endswith("is <= 399"), lines[2])

    def test_a_characteristic_has_the_name_that_reports_give_it(self):
        other = LENGTH.replace("ENDFIL", "F(C)=FEAT/POINT,CART,400,0,0,1,0,0\nMEAS/POINT,F(C),1\nPTMEAS/CART,400,0,0,1,0,0\nENDMES\n"
                               "OUTPUT/FA(A),FA(C),TA(LEN)\nOUTPUT/FA(B),FA(C),TA(LEN)\nENDFIL")
        self.program("FA(A),FA(B),TA(LEN) value <= 101", "FA(A), FA(C), TA(LEN) value >= 399", "FA(B) FA(C) TA(LEN) occurrence 1 value <= 301", text=other)
        self.abbe("test", "length.dmi")
        self.program("FA(B),FA(B2),TA(LEN) value <= 101", text=other)
        self.assertIn("evaluates no FA(B),FA(B2) with TA(LEN)", self.abbe("test", "length.dmi", code=1).stdout)

    def test_check_counts_occurrences_as_a_report_does(self):
        # Two lines that evaluate the same have one occurrence each; a loop has as many as it makes.
        self.program("TA(LEN) occurrence 2 u >= 0", text=LENGTH.replace("ENDFIL", "OUTPUT/FA(A),FA(B),TA(LEN)\nENDFIL"))
        self.assertIn("E0608", self.abbe("test", "length.dmi", code=1).stdout)
        said = self.abbe("check", "length.dmi", code=1)
        self.assertIn("error E0215: no line of this program evaluates TA(LEN) more than 1 time", said.stdout + said.stderr)
        output = "OUTPUT/FA(A),FA(B),TA(LEN)\n"
        for limit, kind in (("2", "turns written out"), ("N-98", "turns as many as measured")):
            with self.subTest(kind):
                looped = LENGTH.replace(output, f"DECL/INTGR,N\nN=OBTAIN/FA(B),4\nDO/I,1,{limit}\n{output}ENDDO\n").replace("CART,100,", "CART,100.5,")
                self.program("TA(LEN) occurrence 2 u >= 0", text=looped)
                self.assertIn("1 passed, 0 failed", self.abbe("test", "length.dmi").stdout)
                self.abbe("check", "length.dmi")

    def test_a_micrometre_of_a_length_shows(self):
        self.program("TA(LEN) value between 100.0000001 100.1", "TA(LEN) mean >= 101")
        said = self.abbe("test", "length.dmi", code=1).stdout
        self.assertIn("TA(LEN) value = 100, is not", said)
        self.assertRegex(said, r"TA\(LEN\) mean = (100\.000\d{1,3}|99\.999\d{1,3}), is not >= 101")

    def test_a_failure_is_exit_code_1(self):
        self.program("TA(LEN) u <= 0.000001", "TA(LEN) u >= 0")
        done = self.abbe("test", "length.dmi", code=1)
        self.assertRegex(done.stdout, r"FAIL +length.dmi:2: TA\(LEN\) u = 0.00\d+, is not <= 1e-06\n")
        self.assertIn("1 passed, 1 failed", done.stdout)

    def test_unknown_characteristics_fail_with_a_suggestion(self):
        self.program("TA(LENN) u >= 0", "FA(C) TA(LEN) u >= 0", "TA(LEN) occurrence 2 u >= 0")
        done = self.abbe("test", "length.dmi", code=1)
        self.assertIn("0 passed, 3 failed", done.stdout)
        self.assertIn("E0608", done.stdout)
        self.assertIn("did you mean TA(LEN)?", done.stdout)
        self.assertIn("FA(C) with TA(LEN)", done.stdout)
        self.assertIn("occurrence 2", done.stdout)

    def test_expectations_that_cannot_be_read_fail(self):
        self.program("TA(LEN) q95 >= 0", "TA(LEN) u >= 0")
        done = self.abbe("test", "length.dmi", code=1)
        self.assertIn("FAIL  length.dmi:2:", done.stdout)
        self.assertIn("1 passed, 1 failed", done.stdout)

    def test_a_program_with_errors_fails(self):
        self.program("TA(LEN) u >= 0", text=LENGTH.replace("T(LEN)=TOL", "T(LEN)=TLO"))
        self.assertIn("has errors", self.abbe("test", "length.dmi", code=1).stdout)

    def test_a_program_that_cannot_run_fails_and_the_others_go_on(self):
        self.program("TA(LEN) u >= 0", name="a.dmi", text=LENGTH.replace("XORIG,800", "XORIG,1550"))
        self.program("TA(LEN) u >= 0", name="b.dmi")
        done = self.abbe("test", ".", code=1)
        self.assertIn("outside the travel", done.stdout)
        self.assertIn("1 passed, 1 failed", done.stdout)

    def test_a_program_that_cannot_be_read_fails_and_the_others_go_on(self):
        self.program("TA(LEN) u >= 0", name="a.dmi")
        self.write("b.dmi", LENGTH.encode("utf-16"))
        self.write("c.dmi", "feature,touch,x,y,z\nA,1,0,0,0\n")
        self.program("TA(LEN) u >= 0", name="d.dmi")
        done = self.abbe("test", ".", "--junit", "out.xml", code=1)
        self.assertEqual([line.split()[0] for line in done.stdout.splitlines()[:-1]], ["ok", "FAIL", "FAIL", "ok"])
        self.assertIn("2 passed, 2 failed", done.stdout)
        self.assertIn("b.dmi:1: './b.dmi' is in UTF-16", done.stdout)
        self.assertIn("E0618", done.stderr)
        suites = ElementTree.parse(self.folder / "out.xml").getroot().findall("testsuite")
        self.assertEqual([suite.get("failures") for suite in suites], ["0", "1", "1", "0"])
        self.refused("E0601", "test", "a.dmi", "missing.dmi")

    def test_folders_are_searched(self):
        self.program("TA(LEN) u >= 0", name="one/a.dmi")
        self.program("TA(LEN) u >= 0", name="one/two/b.DMI")
        self.write("one/c.dmi", LENGTH)
        self.write("one/d.txt", "$$! expect TA(LEN) u <= 0\n")
        self.assertIn("2 passed, 0 failed", self.abbe("test", "one").stdout)

    def test_settings_of_the_command_line_win(self):
        self.program("accepted >= 0")
        self.abbe("test", "length.dmi", "--machines", 50, "--seed", 3)
        self.assertIn("0 virtual machines", self.abbe("test", "length.dmi", "--machines", 0, code=1).stdout)

    def test_nothing_to_test(self):
        self.write("length.dmi", LENGTH)
        self.refused("E0607", "test", ".")
        self.refused("E0601", "test", "missing.dmi")


class JUnit(harness.Case):
    def test_results_as_xml(self):
        folder = "a&b <'\"> \u00e4"
        text = "$$! machines 50\n$$! expect TA(LEN) u <= 0\n$$! expect TA(LEN) u >= 0\n" + LENGTH
        self.write(f"{folder}/length.dmi", text)
        self.write(f"{folder}/other.dmi", "$$! expect TA(LEN) u\n" + LENGTH)   # cannot be read: it fails
        self.abbe("test", folder, "--junit", "out.xml", code=1)
        root = ElementTree.parse(self.folder / "out.xml").getroot()
        self.assertEqual((root.tag, root.get("tests"), root.get("failures")), ("testsuites", "3", "2"))
        self.assertEqual([(s.get("tests"), s.get("failures")) for s in root], [("2", "1"), ("1", "1")])
        suite = root.find("testsuite")
        self.assertEqual(suite.get("name"), f"{folder}/length.dmi")
        failed, passed = suite.findall("testcase")
        self.assertIn("u <= 0", failed.get("name"))
        self.assertIn("is not <= 0", failed.find("failure").get("message"))
        self.assertIsNone(passed.find("failure"))
        self.assertEqual(passed.get("line"), "3")

    def test_bytes_that_are_not_utf_8(self):
        self.write("length.dmi", b"$$! machines 50\n$$! expect TA(\xe4\x01) u <= 0\n" + LENGTH.encode())
        self.abbe("test", "length.dmi", "--junit", "out.xml", code=1)
        ElementTree.parse(self.folder / "out.xml")

    def test_a_file_that_cannot_be_written(self):
        self.write("length.dmi", "$$! machines 50\n$$! expect TA(LEN) u >= 0\n" + LENGTH)
        self.assertIn("E0602", self.abbe("test", "length.dmi", "--junit", "no/such/out.xml", code=2).stderr)


harness.main()
