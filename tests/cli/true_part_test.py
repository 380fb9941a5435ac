"""Tolerances of a part that is not nominal, because a workpiece file or a recording says so: what is nominal stays where the program
put it, whatever the true part is like."""
import harness

HEAD = """$$! place 800 500 -400
DMISMN/'a block with a bore',5.2
UNITS/MM,ANGDEC
S(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4
SNSLCT/S(P)
"""


def measured(kind, label, touches):
    lines = [f"PTMEAS/CART,{','.join(f'{x:.6f}' for x in touch)}\n" for touch in touches]
    return f"MEAS/{kind},F({label}),{len(lines)}\n" + "".join(lines) + "ENDMES\n"


def plane(label, corners, normal):
    nominal = ",".join(str(x) for x in corners[0] + normal)
    return f"F({label})=FEAT/PLANE,CART,{nominal}\n" + measured("PLANE", label, [c + normal for c in corners])


BORE = "F(H)=FEAT/CIRCLE,INNER,CART,50,40,-5,0,0,1,20\n"
BORE_TOUCHES = measured("CIRCLE", "H", [(60, 40, -5, -1, 0, 0), (50, 50, -5, 0, -1, 0), (40, 40, -5, 1, 0, 0), (50, 30, -5, 0, 1, 0)])
DATUMS = (plane("A", [(0, 0, 0), (100, 0, 0), (100, 80, 0), (0, 80, 0)], (0, 0, 1))
          + plane("B", [(0, 0, -5), (100, 0, -5), (100, 0, -15), (0, 0, -15)], (0, -1, 0))
          + plane("C", [(0, 0, -5), (0, 80, -5), (0, 80, -15), (0, 0, -15)], (-1, 0, 0))
          + "DATDEF/FA(A),DAT(A)\nDATDEF/FA(B),DAT(B)\nDATDEF/FA(C),DAT(C)\n")
ALIGNMENT = "D(R)=DATSET/DAT(A),ZDIR,ZORIG,DAT(B),-YDIR,YORIG,DAT(C),XORIG\n"
BACK = plane("U", [(0, 80, -5), (100, 80, -5), (100, 80, -15), (0, 80, -15)], (0, 1, 0))
TOLERANCES = """T(POS)=TOL/POS,2D,0.1,DAT(A),DAT(B),DAT(C)
T(PLAIN)=TOL/POS,2D,0.1
T(Y)=TOL/CORTOL,YAXIS,-0.05,0.05
T(FROM_B)=TOL/DISTWRT,NOMINL,40,-0.05,0.05,FA(B),YAXIS
T(FROM_DATUM)=TOL/DISTWRT,NOMINL,40,-0.05,0.05,DAT(B),YAXIS
T(PROFILE)=TOL/PROFS,-0.05,0.05,DAT(A),DAT(B),DAT(C)
T(POS_U)=TOL/POS,3D,0.1,DAT(A),DAT(B),DAT(C)
"""
OUTPUT = "OUTPUT/FA(H),TA(POS),TA(PLAIN),TA(Y),TA(FROM_B),TA(FROM_DATUM)\nOUTPUT/FA(U),TA(PROFILE),TA(POS_U)\n"
OFFSET_B = '{"schema": "abbe.workpiece/1", "name": "B stands out", "surfaces": {"B": {"offset_um": 100}}}'

# B lies 0.1 mm further out: bore and back lie 0.1 mm too far from it, and twice that is their deviation in the frame of A, B and C.
FAR_FROM_B = {"POS": 0.2, "FROM_B": 40.1, "FROM_DATUM": 40.1, "PROFILE": 0.2, "POS_U": 0.2}


class TruePart(harness.Case):
    def program(self, *parts):
        return self.write("part.dmi", HEAD + "".join(parts) + "ENDFIL\n")

    def references(self, *options):
        report = self.run_json("part.dmi", "--machines", 40, *options)
        return {c["tolerance"]: c["reference"] for c in report["characteristics"]}

    def recording(self, deviation):
        """Of the program, with every touch that deviation(feature, touch) off its target, along the normal. mm"""
        self.abbe("record", "part.dmi", "-o", "plain.csv")

        def moved(row):
            off = deviation(row["feature"], int(row["touch"]))
            return row | {x: repr(float(row["t" + x]) + float(row["n" + x]) * off) for x in "xyz"}
        return self.changed(self.folder / "plain.csv", moved, "true.csv")

    def assert_close(self, found, expected, delta=1e-6):
        for name, value in expected.items():
            self.assertAlmostEqual(found[name], value, delta=delta, msg=name)

    def true_parts(self):
        """B further out by 0.1 mm, said in two ways."""
        self.write("b.json", OFFSET_B)
        return ("--workpiece", "b.json"), ("--recording", self.recording(lambda feature, touch: 0.1 if feature == "B" else 0))

    def test_a_feature_is_judged_from_where_the_true_datum_lies(self):
        self.program(DATUMS, BORE, BORE_TOUCHES, BACK, TOLERANCES, OUTPUT)
        for part in self.true_parts():
            self.assert_close(self.references(*part), FAR_FROM_B | {"PLAIN": 0, "Y": 0})

    def test_what_a_coordinate_system_on_the_datums_puts_follows_them(self):
        # The workpiece lies where PTMEAS says in the system that stands on B: bore and back are 40 and 80 mm from it.
        self.program(DATUMS, ALIGNMENT, BORE, BORE_TOUCHES, BACK, TOLERANCES, OUTPUT)
        workpiece, recording = self.true_parts()
        self.assert_close(self.references(*workpiece), {"POS": 0, "PLAIN": 0, "Y": 0, "FROM_B": 40, "FROM_DATUM": 40, "PROFILE": 0, "POS_U": 0})
        # The recording has them where the machine found them, 0.1 mm further from B. A recorded point counts along the normal only: two of
        # the bore's touches slide 0.1 mm along it, which moves the centre by some nm.
        self.assert_close(self.references(*recording), FAR_FROM_B | {"PLAIN": 0.2, "Y": 0.1}, delta=1e-5)

    def test_a_nominal_stays_in_its_system_when_the_datums_are_measured(self):
        # Bore and nominal are defined before the system is set on B. Where B was found moves no nominal: the bore is 40.1 mm from it.
        self.program(BORE, BORE_TOUCHES, BACK, DATUMS, ALIGNMENT, TOLERANCES, OUTPUT)
        for part in self.true_parts():
            self.assert_close(self.references(*part), FAR_FROM_B | {"PLAIN": 0.2, "Y": 0.1})

    def test_machines_that_take_another_path_know_what_is_nominal_there(self):
        # On the nominal part nothing would be evaluated: B lies at -0.1 mm. Noise then sends half of the machines each way.
        self.program(DATUMS, BORE, BORE_TOUCHES, BACK, TOLERANCES,
                     "DECL/LOCAL,REAL,BY,HX\nBY=OBTAIN/FA(B),5\nHX=OBTAIN/FA(H),5\nIF/(BY.LT.-0.05)\nIF/(HX.GT.50)\n", OUTPUT,
                     "ELSE\n", OUTPUT, "ENDIF\nENDIF\n")
        for part in self.true_parts():
            report = self.run_json("part.dmi", "--machines", 40, *part)
            found = [c for c in report["characteristics"] if c["tolerance"] == "POS"]
            self.assertEqual(len(found), 2)
            self.assertEqual(sum(c["evaluated"] for c in found), 40)
            for c in found:
                self.assertGreater(c["evaluated"], 0)
                self.assertAlmostEqual(c["mean"], 0.2, delta=0.02)

    def test_a_profile_holds_recorded_touches_against_their_targets(self):
        # Touches 0.5, 0.3, 0.4 and 0.2 mm outside the nominal surface: the zone about it that holds them is 2 x 0.5 mm wide, about the
        # middle of -0.02 and 0.06 it is 2 x (0.5 - 0.02) mm.
        top = plane("T", [(0, 0, 20), (100, 0, 20), (100, 80, 20), (0, 80, 20)], (0, 0, 1))
        self.program(DATUMS, top, "T(S)=TOL/PROFS,-0.05,0.05\nT(L)=TOL/PROFL,-0.02,0.06\nT(SA)=TOL/PROFS,-0.05,0.05,DAT(A)\n",
                     "OUTPUT/FA(T),TA(S),TA(L),TA(SA)\n")
        recording = self.recording(lambda feature, touch: (0.5, 0.3, 0.4, 0.2)[touch - 1] if feature == "T" else 0)
        report = self.run_json("part.dmi", "--machines", 40, "--recording", recording)
        self.assert_close({c["tolerance"]: c["reference"] for c in report["characteristics"]}, {"S": 1.0, "L": 0.96, "SA": 1.0})
        for c in report["characteristics"]:
            self.assertEqual(c["conformance_probability"], 0)

    def test_recorded_points_hold_what_is_known_of_the_part(self):
        # The bore is 30 um larger, the points of the true part say so already: its certificate adds an uncertainty, no size.
        self.program(DATUMS, BORE, BORE_TOUCHES, "T(D)=TOL/DIAM,-0.1,0.1\nT(R)=TOL/CIRLTY,0.1\nOUTPUT/FA(H),TA(D),TA(R)\n")
        recording = self.recording(lambda feature, touch: (-0.017, -0.013)[touch % 2] if feature == "H" else 0)
        known = self.write("w.json", """{"schema": "abbe.workpiece/1", "name": "w", "surfaces": {"H": {
            "diameter_deviation_um": 30, "form": [{"undulations": 2, "amplitude_um": 2, "phase_deg": 0}]}}}""")
        doubtful = self.write("doubtful.json", """{"schema": "abbe.workpiece/1", "name": "w", "surfaces": {"H": {
            "diameter_deviation_um": {"value": 30, "u": 3}}}}""")
        measured = {"D": 20.03, "R": 0.004}
        self.assert_close(self.references("--workpiece", known), measured)
        self.assert_close(self.references("--recording", recording), measured)
        self.assert_close(self.references("--recording", recording, "--workpiece", known), measured)
        self.assert_close(self.references("--recording", recording, "--workpiece", doubtful), measured)

        def report(workpiece):
            r = self.run_json("part.dmi", "--machines", 400, "--recording", recording, "--workpiece", workpiece)
            return r["characteristics"][0], {i["name"]: i["status"] for i in r["influences"]}

        size, influences = report(known)
        self.assertEqual(size["contributions"]["part"], 0)
        self.assertEqual((influences["true size of the part"], influences["form error of the part"]), ("not modelled",) * 2)
        size, influences = report(doubtful)
        self.assertAlmostEqual(size["u"], 0.003, delta=0.0005)
        self.assertEqual(influences["true size of the part"], "modelled")

    def slot(self, lean_mm):
        """Touches of both faces of a slot at x = +-5 mm, y from 0 to 100, z from -10 to 0, that lean by that much over the depth."""
        corners = [(0, 0), (100, 0), (100, -10), (0, -10)]
        return [[(side * 5 + lean_mm * (z + 5) / 10, y, z, -side, 0, 0) for y, z in corners] for side in (1, -1)]

    def test_a_median_plane_is_looked_at_where_its_faces_were_touched(self):
        # The slot leans by 10 um over its depth, 5 um to each side of x = 0: a zone of 10 um holds its median plane. The feet of touches
        # 5 mm beside it lie 5 mm x 0.001 further up or down, which makes 10.01 um.
        right, left = self.slot(0.010)
        wall = plane("W", [(0, 0, 0), (0, 100, 0), (0, 100, -10), (0, 0, -10)], (1, 0, 0)) + "DATDEF/FA(W),DAT(W)\n"
        tolerances = "T(SYM)=TOL/SYM,0.05,DAT(W)\nT(PERP)=TOL/PERP,0.05,DAT(A)\nT(PARLEL)=TOL/PARLEL,0.05,DAT(W)\nT(POS)=TOL/POS,3D,0.05\n"
        expected = {"SYM": 0.010, "PERP": 0.010, "PARLEL": 0.010, "POS": 0.010}
        measured_slot = "F(S)=FEAT/PARPLN,INNER,MIDPL,CART,0,50,-5,1,0,0,10\n" + measured("PARPLN", "S", right + left)
        faces = ("F(R)=FEAT/PLANE,CART,5,50,-5,-1,0,0\n" + measured("PLANE", "R", right) + "F(L)=FEAT/PLANE,CART,-5,50,-5,1,0,0\n"
                 + measured("PLANE", "L", left) + "F(S)=FEAT/PLANE,CART,0,50,-5,1,0,0\nCONST/PLANE,F(S),MIDPL,FA(R),FA(L)\n")
        for slot in (measured_slot, faces):
            self.program(DATUMS, wall, slot, tolerances, "OUTPUT/FA(S),TA(SYM),TA(PERP),TA(PARLEL),TA(POS)\n")
            self.assert_close(self.references(), expected, delta=2e-5)

    def test_a_slot_in_a_face_stops_the_rotation(self):
        # The true slot is turned by 1 mrad about its centre at 20,40: its sides, touched 10 mm to both sides of that, lie 10 um off. In
        # its system the bore, 30 mm from that centre, is 30 um off; in one that is turned about the corner of the part, 50,40 from it,
        # 40 um along x and -50 um along y.
        slot = ("F(S)=FEAT/CPARLN,INNER,ROUND,CART,20,40,-5,0,0,1,1,0,0,30,10\n"
                + measured("CPARLN", "S", [(30, 45, -5, 0, -1, 0), (10, 45, -5, 0, -1, 0), (30, 35, -5, 0, 1, 0), (10, 35, -5, 0, 1, 0),
                                           (35, 40, -5, -1, 0, 0), (5, 40, -5, 1, 0, 0)]) + "DATDEF/FA(S),DAT(S)\n")
        self.program(DATUMS, BORE, BORE_TOUCHES, slot, "T(POS)=TOL/POS,2D,0.1,DAT(A),DAT(S)\nOUTPUT/FA(H),TA(POS)\n",
                     "D(TURNED)=ROTATE/ZAXIS,DAT(S),XDIR\nT(X)=TOL/CORTOL,XAXIS,-1,1\nT(Y)=TOL/CORTOL,YAXIS,-1,1\nOUTPUT/FA(H),TA(X),TA(Y)\n")
        recording = self.recording(lambda feature, touch: (-0.01, 0.01, 0.01, -0.01, 0, 0)[touch - 1] if feature == "S" else 0)
        self.assert_close(self.references("--recording", recording), {"POS": 0.06, "X": 0.04, "Y": -0.05}, delta=5e-5)


if __name__ == "__main__":
    harness.main()
