#!/usr/bin/env python3
"""abbe run --only-valid: what can be evaluated is evaluated; what cannot is listed with the line, the reason, and the mistake at the end
of the reason."""
import json

import harness
from harness import LENGTH

POINT = """F({0})=FEAT/POINT,CART,{1},0,0,1,0,0
MEAS/POINT,F({0}),1
PTMEAS/CART,{1},0,0,1,0,0
ENDMES
"""
# One mistake in the measurement of C (line 23), one in the coordinate system (line 32).
PROGRAM = LENGTH.replace("ENDFIL\n", "") + """please look at the part
TEXT/OPER,'now the second
""" + POINT.format("C", 50).replace("PTMEAS/CART,50,0", "PTMEAS/CART,50 0") + """OUTPUT/FA(A),FA(C),TA(LEN)
OUTPUT/FA(A),FA(D),TA(LEN)
CONST/POINT,F(E),MOVEPT,FA(C),1,0,0
DATDEF/FA(C),DAT(Q)
OUTPUT/FA(A),FA(B),TA(LEN)
D(NEW)=DATSET/DAT(Q),ZDIR
OUTPUT/FA(A),FA(B),TA(LEN)
RECALL/D(MCS)
OUTPUT/FA(A),FA(B),TA(LEN)
ENDFIL
DMISMN/'another',4.0
OUTPUT/FA(A),FA(B),TA(LEN)
ENDFIL
"""


class OnlyValid(harness.Case):
    def setUp(self):
        super().setUp()
        self.write("found.dmi", PROGRAM)
        self.first = LENGTH.count("\n")  # the line of the first statement that is added

    def test_what_can_be_evaluated_is_evaluated(self):
        report = self.run_json("found.dmi", "--only-valid", "--machines", 20)
        self.assertEqual([c["line"] for c in report["characteristics"]], [16, self.first + 10, self.first + 14])
        self.write("sound.dmi", LENGTH)
        sound = self.run_json("sound.dmi", "--machines", 20)
        self.assertEqual(report["characteristics"][0]["u"], sound["characteristics"][0]["u"])

    def test_what_is_lost_says_why_down_to_the_mistake(self):
        mistake = f"line {self.first + 4}: a comma is missing in '50 0'"
        expected = [
            (self.first + 6, "A, C", "TA(LEN): FA(C) is not measured <- " + mistake),
            (self.first + 7, "A, D", "TA(LEN): feature FA(D) is not defined above"),
            (self.first + 12, "A, B",
             f"TA(LEN): the coordinate system is in doubt <- line {self.first + 11}: datum DAT(Q) is not usable <- line {self.first + 9}: FA(C) is not measured <- " + mistake),
            (self.first + 17, "A", "it belongs to a second program in the file"),
        ]
        report = self.run_json("found.dmi", "--only-valid", "--machines", 20)
        found = [(lost["line"], lost["feature"], lost["reason"]) for lost in report["lost"]]
        self.assertEqual(found, expected)
        text = self.abbe("run", "found.dmi", "--only-valid", "--machines", 20).stdout
        for line, feature, reason in expected:
            self.assertIn(f"lost: line {line}: {feature}: {reason}\n", text)

    def test_the_line_to_blame_is_that_of_the_message(self):
        cone = "F(K)=FEAT/CONE,INNER,CART,150,30,-20,0,0,1,90\nMEAS/CONE,F(K),8\nENDMES\nT(N)=TOL/ANGL,-0.1,0.1\nOUTPUT/FA(K),TA(N)\nENDFIL\n"
        self.write("cone.dmi", LENGTH.replace("ENDFIL\n", cone))
        lost, = self.run_json("cone.dmi", "--only-valid", "--machines", 20)["lost"]
        self.assertIn(f"<- line {self.first + 1}: this MEAS has no PTMEAS", lost["reason"])

    def test_what_no_machine_can_evaluate_is_lost_alone(self):
        # A plane through a point has no extent, so that its orientation has no zone.
        face = "F(M)=FEAT/PLANE,CART,0,0,0,-1,0,0\nMEAS/PLANE,F(M),3\n" + "".join(f"PTMEAS/CART,0,{y},{z},-1,0,0\n" for y, z in ((0, 0), (9, 0), (0, 9)))
        constructed = ("ENDMES\nF(N)=FEAT/PLANE,CART,0,0,0,-1,0,0\nCONST/PLANE,F(N),PARTO,FA(M),THRU,FA(A)\nT(PA)=TOL/PARLEL,0.1,FA(M)\nT(FL)=TOL/FLAT,0.1\n"
                       "OUTPUT/FA(N),TA(PA)\nOUTPUT/FA(M),TA(FL)\nENDFIL\n")
        program = LENGTH.replace("ENDFIL\n", face + constructed)
        self.write("extent.dmi", program)
        self.assertIn("--only-valid", self.refused("E0304", "run", "extent.dmi", "--machines", 20))
        report = self.run_json("extent.dmi", "--only-valid", "--machines", 20)
        self.assertEqual([c["tolerance"] for c in report["characteristics"]], ["LEN", "FL"])
        line = program[:program.index("OUTPUT/FA(N)")].count("\n") + 1
        self.assertEqual(report["lost"], [{"line": line, "feature": "N",
                                           "reason": "TA(PA): the extent of the feature is not known, so that it has no zone"}])
        # Nothing else changes: the lengths are those of the program without it.
        self.write("sound.dmi", LENGTH)
        self.assertEqual(report["characteristics"][0]["u"], self.run_json("sound.dmi", "--machines", 20)["characteristics"][0]["u"])

    def test_what_stands_in_blocks_that_cannot_be_decided_is_lost(self):
        blocks = "".join(f"{begin}\nOUTPUT/FA(A),FA(B),TA(LEN)\n{end}\n" for begin, end in
                         (("IF/(VV .GT. 1)", "ENDIF"), ("DO/I,1,VV", "ENDDO"), ("DO/I,1,3,0", "ENDDO"), ("SELECT/VV\nCASE/1", "ENDCAS\nENDSEL"),
                          ("SELECT/1\nCASE/'A'", "ENDCAS\nENDSEL")))
        program = LENGTH.replace("ENDFIL\n", blocks + "ENDFIL\n")
        self.write("blocks.dmi", program)
        report = self.run_json("blocks.dmi", "--only-valid", "--machines", 20)
        asked = [k + 1 for k, line in enumerate(program.splitlines()) if line.startswith("OUTPUT")]
        self.assertEqual([c["line"] for c in report["characteristics"]], asked[:1])
        self.assertEqual([lost["line"] for lost in report["lost"]], asked[1:])
        for lost in report["lost"]:
            self.assertEqual(lost["feature"], "A, B")
            self.assertIn(f"line {self.first}: VV is no variable", lost["reason"])

    def test_what_no_machine_can_construct_is_lost_with_what_rests_on_it(self):
        face = "F({0})=FEAT/PLANE,CART,0,0,{1},0,0,1\nMEAS/PLANE,F({0}),3\n" + "".join(f"PTMEAS/CART,{x},{y},{{1}},0,0,1\n" for x, y in ((0, 0), (9, 0), (0, 9))) + "ENDMES\n"
        edge = "F(E)=FEAT/LINE,UNBND,CART,0,0,0,1,0,0,0,0,1\nCONST/LINE,F(E),INTOF,FA(M),FA(N)\n"
        program = LENGTH.replace("ENDFIL\n", face.format("M", 0) + face.format("N", -5) + edge + """T(AN)=TOL/ANGLB,NOMINL,0,-1,1
OUTPUT/FA(E),FA(M),TA(AN)
OUTPUT/FA(A),FA(B),TA(LEN)
D(NEW)=ROTATE/ZAXIS,FA(E),XDIR
OUTPUT/FA(A),FA(B),TA(LEN)
RECALL/D(R)
OUTPUT/FA(A),FA(B),TA(LEN)
ENDFIL
""")
        self.write("parallel.dmi", program)
        self.assertIn("--only-valid", self.refused("E0304", "run", "parallel.dmi", "--machines", 20))
        done = self.abbe("run", "parallel.dmi", "--only-valid", "--machines", 20, "--format", "json")
        report, line = json.loads(done.stdout), program[:program.index("CONST/LINE")].count("\n") + 1
        self.assertIn(f"parallel.dmi:{line}:1: error E0304: not even an error-free machine can do this", done.stderr)
        asked = [k + 1 for k, text in enumerate(program.splitlines()) if text.startswith("OUTPUT")]
        self.assertEqual([c["line"] for c in report["characteristics"]], [asked[0], asked[2], asked[4]])
        self.assertEqual([lost["line"] for lost in report["lost"]], [asked[1], asked[3]])
        for lost in report["lost"]:
            self.assertIn(f"line {line}: not even an error-free machine can do this: ", lost["reason"])

    def test_default_touches_do_not_stand_for_a_scan(self):
        scan = "P(1)=PATH/ARC,CART,0,0,0,0,0,1,25,0,360\nF(K)=FEAT/CIRCLE,INNER,CART,50,0,0,0,0,1,50\nMEAS/CIRCLE,F(K),40\nPAMEAS/P(1),0,0,-1\nENDMES\nT(N)=TOL/DIAM,-0.1,0.1\nOUTPUT/FA(K),TA(N)\nENDFIL\n"
        self.write("scan.dmi", LENGTH.replace("ENDFIL\n", scan))
        report = self.run_json("scan.dmi", "--machines", 20)
        self.assertEqual([c["tolerance"] for c in report["characteristics"]], ["LEN", "N"])
        self.assertIn("40 default touches stand for this scan", next(m["message"] for m in report["messages"] if m["code"] == "W0261"))
        report = self.run_json("scan.dmi", "--only-valid", "--machines", 20)
        self.assertEqual([c["tolerance"] for c in report["characteristics"]], ["LEN"])
        self.assertEqual([lost["reason"] for lost in report["lost"]], [f"TA(N): FA(K) is not measured <- line {self.first + 3}: its scan is not supported yet"])
        self.assertNotIn("W0261", [m["code"] for m in report["messages"]])

    def test_what_a_jump_that_cannot_be_read_takes_away(self):
        self.write("jump.dmi", LENGTH.replace("OUTPUT/", "JUMPTOO/(END)\nOUTPUT/").replace("ENDFIL", "(END)\nENDFIL"))
        report = self.run_json("jump.dmi", "--only-valid", "--machines", 20)
        lost, = report["lost"]
        self.assertEqual(lost["reason"], f"TA(LEN): it is not known whether this is run <- line {self.first - 1}: JUMPTOO is not a word of DMIS")

    def test_each_mistake_is_reported_once_at_its_place(self):
        done = self.abbe("check", "found.dmi", code=1)
        places = [line.split(":")[1] + line.split()[2] for line in done.stderr.splitlines() if line.startswith("found.dmi:")]
        self.assertEqual(places, [f"{self.first + line}{code}:" for line, code in
                                  ((0, "E0101"), (1, "E0102"), (4, "E0105"), (7, "E0201"), (8, "E0201"), (16, "E0209"))])

    def test_any_bytes_and_line_ends(self):
        latin = LENGTH.replace("'a length'", "'L\u00e4nge'").replace("F(A)", "F(\u00c4)").replace("FA(A)", "FA(\u00c4)")
        reports = []
        for name, data in (("crlf.dmi", latin.replace("\n", "\r\n").encode("latin-1")), ("cr.dmi", latin.replace("\n", "\r").encode("latin-1")),
                           ("bom.dmi", b"\xef\xbb\xbf" + latin.rstrip("\n").encode())):
            self.write(name, data)
            reports.append(self.run_json(name, "--machines", 20))
        for report in reports:
            self.assertEqual(report["characteristics"][0]["u"], reports[0]["characteristics"][0]["u"])
            self.assertEqual([m["code"] for m in report["messages"] if m["severity"] == "error"], [])


if __name__ == "__main__":
    harness.main()
