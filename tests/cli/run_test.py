"""abbe run: figures, formats, files, and input that cannot be used."""
import csv
import json
import re
import resource
import statistics
import subprocess

import harness
from harness import LENGTH

KEYS = {"schema", "program", "machine", "seed", "version", "machines", "characteristics", "lost", "traps", "influences", "messages"}
CHARACTERISTIC_KEYS = {"feature", "tolerance", "kind", "unit", "line", "occurrence", "nominal", "reference", "mean", "u", "lcl", "ucl",
                       "interval95", "monte_carlo_error", "tolerance_limits", "conformance_probability", "decision", "contributions", "trapped", "evaluated"}

# A bore of 50 mm, touched in four points.
RING = """DMISMN/'ring',4.0
$$! machine coord3-mc16   machines 300   seed 1
UNITS/MM,ANGDEC
PRCOMP/ON
S(P)=SNSDEF/PROBE,INDEX,POL,0.0,0.0,0.0,0.0,-1.0,100.0,3.0
SNSLCT/S(P)
D(R)=TRANS/XORIG,800.0,YORIG,500.0,ZORIG,-500.0
F(BORE)=FEAT/CIRCLE,INNER,CART,0.0,0.0,-10.0,0.0,0.0,1.0,50.0
T(DIA)=TOL/DIAM,-0.005,0.005
MEAS/CIRCLE,F(BORE),4
PTMEAS/CART,25.0,0.0,-10.0,-1.0,0.0,0.0
PTMEAS/CART,0.0,25.0,-10.0,0.0,-1.0,0.0
PTMEAS/CART,-25.0,0.0,-10.0,1.0,0.0,0.0
PTMEAS/CART,0.0,-25.0,-10.0,0.0,1.0,0.0
ENDMES
OUTPUT/FA(BORE),TA(DIA)
ENDFIL
"""


class Figures(harness.Case):
    def setUp(self):
        super().setUp()
        self.write("length.dmi", LENGTH)

    def test_a_zone_of_0_sets_no_limit(self):
        # B is touched 0.02 mm beside its nominal: out of position by 2 x 0.02 mm.
        far = LENGTH.replace("PTMEAS/CART,100,", "PTMEAS/CART,100.02,").replace("ENDFIL\n", "T(ANY)=TOL/POS,3D,0,RFS\nT(SOME)=TOL/POS,3D,0.01,RFS\nOUTPUT/FA(B),TA(ANY),TA(SOME)\nENDFIL\n")
        self.write("far.dmi", far)
        report = self.run_json("far.dmi", "--machines", 20, "--dmo", "far.dmo")
        found = {c["tolerance"]: c for c in report["characteristics"]}
        self.assertAlmostEqual(found["ANY"]["reference"], 0.04, delta=1e-9)
        self.assertIsNone(found["ANY"]["conformance_probability"])
        self.assertEqual(found["SOME"]["conformance_probability"], 0)
        lines = (self.folder / "far.dmo").read_text().splitlines()
        status = {label: next(line for line in lines if line.startswith(f"TA({label})")) for label in ("ANY", "SOME")}
        self.assertIn("INTOL", status["ANY"])
        self.assertIn("OUTOL", status["SOME"])

    def test_a_zone_below_0_is_met_by_no_value(self):
        self.write("below.dmi", LENGTH.replace("ENDFIL\n", "T(BELOW)=TOL/POS,3D,-0.01,RFS\nOUTPUT/FA(B),TA(BELOW)\nENDFIL\n"))
        report = self.run_json("below.dmi", "--machines", 20, "--dmo", "below.dmo")
        self.assertEqual(report["characteristics"][1]["conformance_probability"], 0)
        self.assertIn("W0264", [m["code"] for m in report["messages"]])
        self.assertIn("OUTOL", next(line for line in (self.folder / "below.dmo").read_text().splitlines() if line.startswith("TA(BELOW)")))

    def test_a_lower_limit_of_0_of_what_has_no_sign_is_that_of_a_zone(self):
        # B is touched twice, and its two faces make an angle of 0: neither value can be below 0, whatever the errors are.
        touches = "".join(f"PTMEAS/CART,100,{y},{z},1,0,0\n" for y, z in ((-40, -40), (40, -40), (0, 40)))
        faces = "".join(f"F({l})=FEAT/PLANE,CART,100,0,0,1,0,0\nMEAS/PLANE,F({l}),3\n{touches}ENDMES\n" for l in ("E1", "E2"))
        self.write("unsigned.dmi", LENGTH.replace("ENDFIL\n", faces + "F(C)=FEAT/POINT,CART,100,0,0,1,0,0\nMEAS/POINT,F(C),1\nPTMEAS/CART,100,0,0,1,0,0\nENDMES\n"
                                                  "T(X)=TOL/DISTB,LIMIT,0,0.05,XAXIS\nT(P)=TOL/DISTB,NOMINL,0,0,0.05,PT2PT\nOUTPUT/FA(B),FA(C),TA(X),TA(P)\n"
                                                  "T(ANGLE)=TOL/ANGLB,LIMIT,0,0.05\nT(AROUND)=TOL/ANGLB,NOMINL,0,-0.05,0.05\nOUTPUT/FA(E1),FA(E2),TA(ANGLE),TA(AROUND)\nENDFIL\n"))
        characteristics = self.run_json("unsigned.dmi", "--machines", 400)["characteristics"]
        self.assertEqual([c["tolerance"] for c in characteristics], ["LEN", "X", "P", "ANGLE", "AROUND"])
        for c in characteristics[1:]:
            self.assertEqual((c["tolerance"], c["tolerance_limits"]), (c["tolerance"], [None, 0.05]))
            self.assertEqual((c["conformance_probability"], c["decision"]["verdict"]), (1, "conforms"))
            self.assertIsNone(c["decision"]["acceptance_limits"][0])
            self.assertGreater(c["decision"]["acceptance_limits"][1], 0)

    def test_a_form_that_no_touch_can_show_is_not_certain(self):
        circle = "F(C{0})=FEAT/CIRCLE,INNER,CART,0,0,0,0,0,1,50\nMEAS/CIRCLE,F(C{0}),{0}\nENDMES\nOUTPUT/FA(C{0}),TA(RO)\n"
        self.write("three.dmi", LENGTH.replace("ENDFIL\n", "T(RO)=TOL/CIRLTY,0.0001\n" + circle.format(3) + circle.format(4) + "ENDFIL\n"))
        report = self.run_json("three.dmi", "--machines", 200, "--dmo", "three.dmo")
        _, three, four = report["characteristics"]
        self.assertEqual((three["conformance_probability"], three["decision"]), (None, None))
        self.assertLess(four["conformance_probability"], 0.5)
        self.assertEqual([m["message"].split(":")[0] for m in report["messages"] if m["code"] == "W0621"], [f"line {three['line']}"])
        rows = [line.split() for line in self.abbe("run", "three.dmi", "--machines", 200).stdout.splitlines() if " C3 " in line]
        self.assertEqual([row[4:9] + [row[11]] for row in rows], [["mm", "0.0000", "-", "-", "-", "-"]])
        self.assertEqual(len([line for line in (self.folder / "three.dmo").read_text().splitlines() if line.startswith("$$! u TA(RO)")]), 1)

    def test_where_a_bore_lies_along_itself_is_not_known(self):
        round_it = [(1, 0), (-0.5, 0.8660254), (-0.5, -0.8660254)]
        touches = "".join(f"PTMEAS/CART,{25 * c},{25 * s},{z},{-c},{-s},0\n" for z in (-5, -25) for c, s in round_it)
        self.write("along.dmi", LENGTH.replace("ENDFIL\n", "F(Y)=FEAT/CYLNDR,INNER,CART,0,0,0,0,0,1,50\nMEAS/CYLNDR,F(Y),6\n" + touches + "ENDMES\n"
                                               "T(Z)=TOL/CORTOL,ZAXIS,-0.1,0.1\nT(X)=TOL/CORTOL,XAXIS,-0.1,0.1\nOUTPUT/FA(Y),TA(Z),TA(X)\nENDFIL\n"))
        report = self.run_json("along.dmi", "--machines", 200)
        _, z, x = report["characteristics"]
        self.assertEqual([z[key] for key in ("u", "conformance_probability", "decision")], [None] * 3)
        self.assertGreater(x["u"], 1e-4)
        told, = [m for m in report["messages"] if m["code"] == "W0621"]
        self.assertIn("TA(Z)", told["message"])
        self.assertIn("as a bore along its axis", told["help"])

    def test_each_message_is_told_once_and_is_on_the_page(self):
        self.write("far.dmi", LENGTH.replace("ENDFIL\n", "N=ASSIGN/3\nGOTO/99999,0,0\nENDFIL\n"))
        done = self.abbe("run", "far.dmi", "--machines", 50, "--format", "json", "--report", "page.html")
        page = (self.folder / "page.html").read_text()
        for line, code in ((17, "W0124"), (18, "W0309")):
            self.assertEqual(done.stderr.count(f"far.dmi:{line}:1: warning {code}: "), 1)
            self.assertEqual(page.count(f"far.dmi:{line}:1: warning {code}: "), 1)
            self.assertEqual([m["code"] for m in json.loads(done.stdout)["messages"]].count(code), 1)
        self.assertEqual(done.stderr.count("W0416"), 1)

    def test_a_line_without_ends_has_none_in_the_result_file(self):
        line = "F({0})=FEAT/LINE,{1},0,0,1\nMEAS/LINE,F({0}),2\nPTMEAS/CART,0,0,0,0,0,1\nPTMEAS/CART,50,0,0,0,0,1\nENDMES\nOUTPUT/FA({0})\n"
        self.write("lines.dmi", LENGTH.replace("ENDFIL\n", line.format("U", "UNBND,CART,0,0,0,1,0,0") + line.format("W", "BND,CART,0,0,0,50,0,0") + "ENDFIL\n"))
        self.abbe("run", "lines.dmi", "--machines", 20, "--dmo", "lines.dmo")
        forms = [row.split(" = ")[1].split(", ")[:2] for row in (self.folder / "lines.dmo").read_text().splitlines() if row.startswith(("FA(U) =", "FA(W) ="))]
        self.assertEqual(forms, [["FEAT/LINE", "UNBND"], ["FEAT/LINE", "BND"]])

    def test_the_result_file_has_the_name_of_filnam_and_repeats_what_output_names(self):
        self.abbe("run", "length.dmi", "--machines", 20, "--dmo", "plain.dmo")
        self.assertEqual((self.folder / "plain.dmo").read_text().splitlines()[0], "FILNAM/'a length'")
        self.write("named.dmi", LENGTH.replace("UNITS", "FILNAM/'the result''s name',4.0\nR(1)=REPORT/DATE\nUNITS")
                   .replace("ENDFIL", "OUTPUT/SA(P)\nOUTPUT/FA(A),FA(B),TA(LEN),R(1)\nENDFIL"))
        self.abbe("run", "named.dmi", "--machines", 20, "--dmo", "named.dmo")
        lines = (self.folder / "named.dmo").read_text().splitlines()
        self.assertEqual(lines[0], "FILNAM/'the result''s name'")
        self.assertEqual([line for line in lines if line.startswith("OUTPUT/")],
                         ["OUTPUT/FA(A), FA(B), TA(LEN)", "OUTPUT/SA(P)", "OUTPUT/FA(A), FA(B), TA(LEN), R(1)"])

    def test_json_has_the_published_keys(self):
        report = self.run_json("length.dmi", "--machines", 200)
        self.assertEqual(report["schema"], "abbe.run/1")
        self.assertLessEqual(KEYS, report.keys())
        self.assertEqual(report["machines"]["used"], 200)
        self.assertEqual(report["machines"]["share_accepted"], 200 / report["machines"]["generated"])
        self.assertEqual(sum(report["machines"][k] for k in ("used", "failed_mpe", "too_small")), report["machines"]["generated"])
        self.assertEqual(len(report["characteristics"]), 1)
        length = report["characteristics"][0]
        self.assertLessEqual(CHARACTERISTIC_KEYS, length.keys())
        self.assertEqual((length["feature"], length["tolerance"], length["kind"], length["unit"], length["line"]),
                         (["A", "B"], "LEN", "DISTB", "mm", 16))
        self.assertIn({"name": "geometry", "status": "modelled"}, report["influences"])
        self.assertIn({"name": "operator", "status": "not modelled"}, report["influences"])

    def test_samples_of_two_lines_are_told_apart(self):
        again = "MEAS/POINT,F(B),1\nPTMEAS/CART,100,0,0,1,0,0\nENDMES\nOUTPUT/FA(A),FA(B),TA(LEN)\nENDFIL\n"
        self.write("again.dmi", LENGTH.replace("ENDFIL\n", again))
        report = self.run_json("again.dmi", "--machines", 20, "--csv", "samples.csv")
        with open(self.folder / "samples.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len({(r["machine"], r["characteristic"], r["line"], r["occurrence"]) for r in rows}), 40)
        for c in report["characteristics"]:
            values = [float(r["value"]) for r in rows if (r["line"], r["occurrence"]) == (str(c["line"]), "1")]
            self.assertAlmostEqual(statistics.mean(values), c["mean"], delta=1e-12)

    def test_figures_agree_with_each_other_and_with_the_samples(self):
        report = self.run_json("length.dmi", "--machines", 500, "--csv", "samples.csv")
        length = report["characteristics"][0]
        with open(self.folder / "samples.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        values = sorted(float(row["value"]) for row in rows)
        self.assertEqual([int(row["machine"]) for row in rows], list(range(500)))
        self.assertEqual({row["characteristic"] for row in rows}, {"FA(A),FA(B),TA(LEN)"})
        self.assertAlmostEqual(length["mean"], statistics.fmean(values), delta=1e-12)
        self.assertAlmostEqual(length["u"], statistics.stdev(values), delta=1e-12)
        # JCGM 101, 7.7.1: M = 500, q = 475, r = int(25/2 + 1/2) = 13.
        self.assertEqual(length["interval95"]["symmetric"], [values[12], values[487]])
        self.assertAlmostEqual(length["lcl"], values[12] - length["reference"], delta=1e-12)
        low, high = length["tolerance_limits"]
        self.assertEqual(length["conformance_probability"], sum(low <= v <= high for v in values) / 500)
        decision, y = length["decision"], length["reference"]
        errors = sorted(v - y for v in values)
        def proven(y):   # both ways round: the true value is y - e, and y + e where errors grow with it
            return all(sum(low <= y + sign * e <= high for e in errors) >= 475 for sign in (1, -1))
        accepted = decision["acceptance_limits"]
        self.assertEqual((decision["rule"], decision["probability"], decision["verdict"]), ("ISO 14253-1:2017", 0.95, "conforms"))
        self.assertAlmostEqual(decision["guard_band"], max(errors[474], -errors[25]), delta=1e-12)
        self.assertAlmostEqual(accepted[0] - low, decision["guard_band"], delta=1e-12)
        self.assertAlmostEqual(high - accepted[1], decision["guard_band"], delta=1e-12)
        self.assertEqual([proven(y) for y in (accepted[0] - 1e-7, accepted[0] + 1e-9, y, accepted[1] - 1e-9, accepted[1] + 1e-7)],
                         [False, True, True, True, False])
        self.assertAlmostEqual(decision["tolerance_to_uncertainty"], 2 * (high - low) / (values[487] - values[12]), delta=1e-9)
        self.assertAlmostEqual(sum(length["contributions"].values()), 1, delta=1e-12)
        self.assertEqual(length["contributions"]["head"], 0)   # one head position: indexing shifts both touches alike
        self.assertAlmostEqual(length["reference"], 100, delta=1e-9)

    def test_the_result_depends_on_the_seed_and_not_on_threads(self):
        def text(*options):
            return self.abbe("run", "length.dmi", "--machines", 300, "--format", "json", *options).stdout
        self.assertEqual(text("--threads", 1), text("--threads", 3))
        self.assertNotEqual(text("--seed", 1), text("--seed", 2))

    def test_directives_settle_what_the_command_line_leaves_open(self):
        self.write("directed.dmi", "$$! machines 60\n$$! seed 9\n$$! machine coord3-mc16\n" + LENGTH)
        report = self.run_json("directed.dmi")
        self.assertEqual((report["machines"]["used"], report["seed"]), (60, 9))
        report = self.run_json("directed.dmi", "--machines", 70, "--seed", 10)
        self.assertEqual((report["machines"]["used"], report["seed"]), (70, 10))

    def test_digits_choose_the_number_of_machines(self):
        report = self.run_json("length.dmi", "--digits", 1)
        self.assertGreaterEqual(report["machines"]["used"], 20000)
        self.assertEqual(report["machines"]["used"] % 10000, 0)
        length = report["characteristics"][0]
        self.assertLess(length["monte_carlo_error"]["u"], 0.05 * length["u"])

    def test_text_is_a_table(self):
        done = self.abbe("run", "length.dmi", "--machines", 200)
        self.assertIn("LEN (DISTB)", done.stdout)
        self.assertIn("200 virtual machines used of", done.stdout)
        self.assertIn("Monte Carlo error of u:", done.stdout)
        self.assertRegex(done.stdout, r"\nestimated cycle time (\d+ min )?\d+ s\n")
        self.assertIn("W0416", done.stderr)   # the paper's machine: fewer than half pass
        self.assertRegex(done.stdout, r"\n +16  A, B +LEN \(DISTB\)  mm +100\.0000  99\.99\d\d to 100\.00\d\d  conforms +\d+\.\d\n")
        self.assertIn("ISO 14253-1:2017 (95 %)", done.stdout)
        self.assertNotIn("\x1b", done.stdout + done.stderr)

    def test_limits_are_shown_as_they_are_written(self):
        self.write("fine.dmi", LENGTH.replace("-0.01,0.01", "-0.00045,0.00004"))
        done = self.abbe("run", "fine.dmi", "--machines", 50)
        self.assertIn("  99.99955  100.00004  ", done.stdout)
        self.assertRegex(done.stdout, r"  none +undecided +\d")

    def test_a_page_beside_the_table(self):
        done = self.abbe("run", "length.dmi", "--machines", 200, "--report", "page.html")
        self.assertEqual(done.stdout, self.abbe("run", "length.dmi", "--machines", 200).stdout)
        page = (self.folder / "page.html").read_text()
        self.assertTrue(page.startswith("<!DOCTYPE html>") and page.endswith("</html>\n"))
        for told in ("A, B: LEN (DISTB)", "<svg", "Decisions", "conforms", "200 virtual machines used of", "not modelled"):
            self.assertIn(told, page)
        self.assertEqual(page, self.abbe("run", "length.dmi", "--machines", 200, "--format", "html").stdout)
        self.refused("E0616", "run", "length.dmi", "--report", "length.dmi")

    def test_a_longer_program_takes_longer(self):
        self.write("long.dmi", LENGTH.replace("F(B)=FEAT", "GOTO/0,0,300\nGOTO/-5,0,0\nF(B)=FEAT"))
        short, long = (self.run_json(name, "--machines", 20)["cycle_time_s"] for name in ("length.dmi", "long.dmi"))
        self.assertGreater(short, 0)
        self.assertGreater(long, short + 1)


BRANCHES = """DMISMN/'rework',4.0
UNITS/MM,ANGDEC
DECL/REAL,D
S(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,150,4
SNSLCT/S(P)
D(R)=TRANS/XORIG,700,YORIG,400,ZORIG,-500
F(H)=FEAT/CIRCLE,INNER,CART,50,30,-5,0,0,1,10
MEAS/CIRCLE,F(H),6
ENDMES
D=OBTAIN/FA(H),11
IF/(D .GT. 10.0001)
T(BIG)=TOL/DIAM,-.01,.01
OUTPUT/FA(H),TA(BIG)
ELSE
T(SMALL)=TOL/DIAM,-.02,.02
OUTPUT/FA(H),TA(SMALL)
ENDIF
ENDFIL
"""


class Branches(harness.Case):
    """A condition on a measured value: what each machine evaluates is reported, as what it is."""

    def setUp(self):
        super().setUp()
        self.write("branches.dmi", BRANCHES)

    def test_every_characteristic_that_a_machine_evaluated_is_a_row(self):
        report = self.run_json("branches.dmi", "--machines", 200, "--csv", "samples.csv")
        small, big = report["characteristics"]
        self.assertEqual((small["tolerance"], big["tolerance"]), ("SMALL", "BIG"))
        self.assertEqual(small["evaluated"] + big["evaluated"], 200)
        self.assertGreater(min(small["evaluated"], big["evaluated"]), 10)
        self.assertAlmostEqual(small["reference"], 10, delta=1e-9)
        self.assertEqual([big[k] for k in ("reference", "lcl", "ucl")], [None] * 3)
        self.assertGreater(big["interval95"]["symmetric"][0], 10.0001)
        self.assertEqual([c["trapped"] for c in (small, big)], [0, 0])
        self.assertEqual((report["traps"], report["lost"]), ([], []))
        self.assertEqual([m["code"] for m in report["messages"]].count("W0619"), 2)
        with open(self.folder / "samples.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(sum(row["characteristic"] == "FA(H),TA(BIG)" for row in rows), big["evaluated"])
        self.assertEqual({row["reference"] for row in rows if row["characteristic"] == "FA(H),TA(BIG)"}, {""})

    def test_the_text_says_of_how_many_machines(self):
        report = self.run_json("branches.dmi", "--machines", 200)
        told = self.abbe("run", "branches.dmi", "--machines", 200)
        for c in report["characteristics"]:
            self.assertIn(f"FA(H),TA({c['tolerance']}): {c['evaluated']} of 200 machines evaluated this: a conditional result", told.stderr)
            self.assertIn(f"% of {c['evaluated']}", told.stdout)

    def test_figures_of_those_that_did_not_stop_are_conditional(self):
        """Some machines divide by zero because of what they measured: the others are no sample of all."""
        self.write("some.dmi", LENGTH.replace("OUTPUT", "X=OBTAIN/FA(B),4\nIF/(X .LT. 99.999)\nX=ASSIGN/1/(X-X)\nENDIF\nOUTPUT", 1))
        told = self.abbe("run", "some.dmi", "--machines", 200, "--format", "json")
        length = json.loads(told.stdout)["characteristics"][0]
        self.assertGreater(length["trapped"], 2)
        self.assertIn(f"{length['evaluated']} of 200 machines evaluated this: a conditional result", told.stderr)
        self.assertIn("the others stopped before", told.stderr)

    def test_an_unknown_uncertainty_is_no_zero(self):
        """A circle through three touches has no form, whatever the machine."""
        self.write("form.dmi", RING.replace("UNITS", "$$! expect TA(DIA) u <= 0.0001\nUNITS", 1)
                   .replace("TOL/DIAM,-0.005,0.005", "TOL/CIRLTY,0.01").replace("F(BORE),4", "F(BORE),3")
                   .replace("PTMEAS/CART,0.0,-25.0,-10.0,0.0,1.0,0.0\n", ""))
        form = self.run_json("form.dmi", "--machines", 20)["characteristics"][0]
        self.assertEqual([form[key] for key in ("u", "lcl", "ucl")], [None] * 3)
        self.assertEqual(form["interval95"]["symmetric"], [None, None])
        self.assertEqual(set(form["contributions"].values()), {None})
        self.assertNotIn("Monte Carlo error", self.abbe("run", "form.dmi", "--machines", 20).stdout)
        self.assertIn("there is none, because nothing that is modelled makes the value vary", self.abbe("test", "form.dmi", code=1).stdout)

    def test_what_moves_every_machine_alike_is_told(self):
        """A block that is 3 K warm, measured without any other error: 11.5 ppm/K x 3 K x 100 mm longer, on every machine."""
        self.write("comparator.json", (harness.ROOT / "examples/gauge_block_h1/comparator.json").read_text())
        self.write("warm.json", '{"schema": "abbe.workpiece/1", "name": "w", "material": {"cte_ppm_per_K": 11.5}, "temperature": {"part_C": 23}}')
        self.write("length.dmi", LENGTH.replace("XORIG,800,YORIG,500,ZORIG,-700", "XORIG,100,YORIG,150,ZORIG,-550"))
        report = self.run_json("length.dmi", "--machine", "comparator.json", "--workpiece", "warm.json", "--machines", 20)
        told, = [m for m in report["messages"] if m["code"] == "W0621"]
        self.assertIn("the same value, 0.00345 mm more than the error-free machine", told["message"])
        self.assertIn("give its uncertainty", told["help"])

    def test_acceptance_limits_are_rounded_inwards(self):
        self.write("ring.dmi", RING)
        lower, upper = self.run_json("ring.dmi")["characteristics"][0]["decision"]["acceptance_limits"]
        said = re.search(r"([\d.]+) to ([\d.]+) +conforms", self.abbe("run", "ring.dmi").stdout)
        self.assertTrue(lower <= float(said[1]) < lower + 2e-5 and upper - 2e-5 < float(said[2]) <= upper, (lower, upper, said))

    def test_limits_in_the_wrong_order_have_no_ratio(self):
        self.write("ring.dmi", RING.replace("-0.005,0.005", "0.005,-0.005"))
        self.assertIsNone(self.run_json("ring.dmi")["characteristics"][0]["decision"]["tolerance_to_uncertainty"])

    def test_expectations_of_a_row_without_reference(self):
        self.write("expected.dmi", BRANCHES.replace("UNITS", "$$! machines 200\n$$! expect TA(BIG) u between 0.00001 0.01\n"
                                                             "$$! expect TA(BIG) value >= 0\nUNITS", 1))
        done = self.abbe("test", "expected.dmi", code=1)
        self.assertIn("1 passed, 1 failed", done.stdout)
        self.assertIn("TA(BIG) value: there is none, because a condition sends the error-free machine past it", done.stdout)

    def test_blocks_of_machines_join_what_paths_evaluate(self):
        stops = "IF/(D .GT. 10.0003)\nD=ASSIGN/1/(D-D)\nENDIF\n"
        self.write("branches.dmi", BRANCHES.replace("T(BIG)", stops + "T(BIG)", 1))
        report = self.run_json("branches.dmi", "--digits", 1)
        stopped = len(report["traps"])
        self.assertGreater(stopped, 10)
        self.assertEqual(len({t["machine"] for t in report["traps"]}), stopped)   # they are counted on from block to block
        self.assertEqual([c["trapped"] for c in report["characteristics"]], [stopped, stopped])
        self.assertEqual(sum(c["evaluated"] for c in report["characteristics"]) + stopped, report["machines"]["used"])


class Refusals(harness.Case):
    def test_settings_out_of_range(self):
        self.write("length.dmi", LENGTH)
        for options in (["--machines", 0], ["--machines", -5], ["--machines", 1], ["--threads", -1], ["--threads", 3000], ["--digits", 3]):
            self.assertIn(str(options[1]), self.refused("E0603", "run", "length.dmi", *options))

    def test_every_command_takes_as_many_threads(self):
        self.write("length.dmi", LENGTH)
        self.abbe("record", "length.dmi", "--machine", "coord3-mc16", "-o", "rec.csv")
        for threads in (-5, 257):
            for command in (["run", "length.dmi"], ["machine", "screen", "precision-500"], ["diagnose", "rec.csv"]):
                self.refused("E0603", *command, "--threads", threads)

    def test_fewer_threads_than_asked_for_do_the_same_work(self):
        """A stack of 1 GiB for each thread, in 4 GiB: only some of the helpers start."""
        self.write("length.dmi", LENGTH)
        def small_computer():
            resource.setrlimit(resource.RLIMIT_STACK, (1 << 30, resource.getrlimit(resource.RLIMIT_STACK)[1]))
            resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
        command = [self.abbe_path, "run", "length.dmi", "--machines", "200", "--format", "json", "--threads"]
        done = subprocess.run([*command, "64"], cwd=self.folder, preexec_fn=small_computer, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, self.abbe(*command[1:], 1).stdout)

    def test_a_program_with_errors_is_not_run(self):
        self.write("wrong.dmi", LENGTH.replace("T(LEN)=TOL", "T(LEN)=TLO"))
        message = self.refused("E0604", "run", "wrong.dmi")
        self.assertIn("wrong.dmi:15:", message)
        self.assertIn("--only-valid", message)
        self.refused("E0604", "run", "wrong.dmi", "--format", "json", "--csv", "samples.csv")
        self.assertFalse((self.folder / "samples.csv").exists())

    def test_only_valid_says_what_is_lost(self):
        second = "T(TWO)=TOL/DISTB,NOMINL,100.0,-0.01,0.01,XAXIS\nOUTPUT/FA(A),FA(B),TA(TWO)\nENDFIL"
        self.write("wrong.dmi", LENGTH.replace("T(LEN)=TOL", "T(LEN)=TLO").replace("ENDFIL", second))
        report = self.run_json("wrong.dmi", "--only-valid", "--machines", 50)
        self.assertEqual([c["tolerance"] for c in report["characteristics"]], ["TWO"])
        self.assertEqual([lost["line"] for lost in report["lost"]], [16])
        self.assertTrue(report["lost"][0]["reason"])
        self.assertIn("error", [m["severity"] for m in report["messages"]])

    def test_a_program_without_characteristics(self):
        self.write("empty.dmi", LENGTH.replace("OUTPUT/FA(A),FA(B),TA(LEN)\n", ""))
        report = self.run_json("empty.dmi", "--machines", 50)
        self.assertEqual(report["characteristics"], [])
        self.assertIn("W0606", [m["code"] for m in report["messages"]])

    def test_an_interval_of_another_coverage(self):
        self.write("length.dmi", LENGTH)
        report = self.run_json("length.dmi", "--machines", 400, "--coverage", "0.5")
        length = report["characteristics"][0]
        low, high = length["interval"]["symmetric"]
        self.assertEqual(length["interval"]["coverage"], 0.5)
        self.assertTrue(length["interval95"]["symmetric"][0] < low < high < length["interval95"]["symmetric"][1])
        self.assertNotIn("W0435", [m["code"] for m in report["messages"]])
        few = self.abbe("run", "length.dmi", "--machines", 400, "--coverage", "0.99")
        self.assertIn("W0435", few.stderr)
        self.assertIn("--machines 2000", few.stderr)
        self.assertIn("shortest 99 %", few.stdout)
        few = self.abbe("run", "length.dmi", "--machines", 399).stderr
        self.assertIn("399 machines are few for 95 % limits", few)
        self.assertIn("--machines 400 or more", few)
        self.assertIn("99 % is 0.99", self.refused("E0603", "run", "length.dmi", "--machines", 20, "--coverage", "99"))
        self.refused("E0603", "run", "length.dmi", "--machines", 20, "--coverage", "0")

    def test_bounds_are_declared(self):
        self.write("length.dmi", LENGTH)
        machine = json.loads((harness.ROOT / "examples/machines/coord3-mc16.json").read_text())
        machine["bounds"] = [{"influence": "thermal drift", "at_most_um": 0.3, "source": "drift test"}]
        self.write("m.json", json.dumps(machine))
        report = self.run_json("length.dmi", "--machine", "m.json", "--machines", 20)
        self.assertIn({"name": "thermal drift", "status": "bounded", "at_most_um": 0.3, "source": "drift test"}, report["influences"])
        self.assertIn("Bounds on influences", self.abbe("machine", "show", "m.json").stdout)
        self.assertEqual(json.loads(self.abbe("machine", "show", "m.json", "--format", "json").stdout)["bounds"], machine["bounds"])
        machine["effects"] = [{"name": "thermal.drift", "parameters": {"amplitude_um": 2}}]
        self.write("m.json", json.dumps(machine))
        self.assertIn("W0434", self.abbe("run", "length.dmi", "--machine", "m.json", "--machines", 20).stderr)

    def test_files(self):
        self.write("length.dmi", LENGTH)
        self.refused("E0601", "run", "missing.dmi")
        self.refused("E0602", "run", "length.dmi", "--machines", 20, "--csv", "no/such/folder/samples.csv")
        self.refused("E0602", "run", "length.dmi", "--machines", 20, "--csv", "")
        self.refused("E0602", "run", "length.dmi", "--machines", 20, "--csv", "whole.csv", "--report", "no/such/folder/report.html")
        self.assertFalse((self.folder / "whole.csv").exists())
        self.assertIn("coord3-mc16", self.refused("E0411", "run", "length.dmi", "--machine", "coord3-mc61"))
        with open("/dev/full", "w") as full:
            self.assertIn("E0602", self.abbe("run", "length.dmi", "--machines", 20, code=2, stdout=full).stderr)

    def test_more_memory_than_there_is(self):
        self.write("length.dmi", LENGTH)
        for command in (("run", "length.dmi"), ("machine", "screen", "coord3-mc16")):
            said = self.refused("E0620", *command, "--machines", 2_000_000_000)   # 4.9 TB
            self.assertIn("2000000000 virtual machines take", said)
            self.assertIn("help: ask for fewer", said)

        def limited(megabytes, machines):
            def limit():
                resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))
            return subprocess.run([self.abbe_path, "run", "length.dmi", "--threads", "1", "--machines", str(machines)], cwd=self.folder, capture_output=True,
                                  text=True, preexec_fn=limit)
        for machines in (40_000_000, 100_000):   # seen before the work, and where the estimate does not see all that is needed
            done = limited(250, machines)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
            self.assertIn("E0620", done.stderr)
            self.assertNotIn("Please report", done.stderr)
        self.assertEqual(limited(250, 100).returncode, 0)

    def test_touches_outside_the_travel(self):
        self.write("outside.dmi", LENGTH.replace("XORIG,800", "XORIG,1550"))
        self.assertIn("outside.dmi:13:", self.refused("E0302", "run", "outside.dmi"))


class Texts(harness.Case):
    def test_latin_1_labels_do_not_break_json(self):
        self.write("latin.dmi", LENGTH.replace("(LEN)", "(L\u00e4nge)").encode("latin-1"))
        done = self.abbe("run", "latin.dmi", "--machines", 20, "--format", "json")
        self.assertEqual(len(json.loads(done.stdout)["characteristics"]), 1)


harness.main()
