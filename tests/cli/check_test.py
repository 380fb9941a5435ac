"""abbe check: what is wrong with a program, and with the machine and workpiece that it names."""
import json

import harness


class Check(harness.Case):
    def told(self, text, code=1):
        """The messages about a program: (code, line)."""
        self.write("program.dmi", text)
        return [(m["code"], m["line"]) for m in json.loads(self.abbe("check", "program.dmi", "--format", "json", code=code).stdout)["messages"]]

    def test_an_empty_file_has_no_end(self):
        for text in ("", "\n", "$$ nothing but a comment\n"):
            self.assertEqual([code for code, _ in self.told(text, code=0)], ["W0225"])

    def test_a_program_without_machine_is_judged_by_itself(self):
        self.assertEqual(self.told(harness.LENGTH.replace("XORIG,800", "XORIG,8000"), code=0), [])

    def test_touches_outside_the_travel_of_the_machine_that_it_names(self):
        named = "$$! machine coord3-mc16\n" + harness.LENGTH
        self.assertEqual(self.told(named, code=0), [])
        outside = named.replace("XORIG,800", "XORIG,8000")
        self.assertEqual(self.told(outside), [("E0302", 10), ("E0302", 14)])
        self.assertEqual(self.told("$$! place -7200 0 0\n" + outside, code=0), [])

    def test_a_default_touch_outside_is_named(self):
        circle = "F(C)=FEAT/CIRCLE,INNER,CART,5,0,0,0,0,1,50\nMEAS/CIRCLE,F(C),4\nENDMES\nENDFIL"
        text = "$$! machine coord3-mc16\n" + harness.LENGTH.replace("XORIG,800", "XORIG,2").replace("ENDFIL", circle)
        self.assertEqual(self.told(text), [("E0302", text[:text.index("MEAS/CIRCLE")].count("\n") + 1)])
        said = self.abbe("check", "program.dmi", code=1).stderr
        self.assertIn("default touch 3 of F(C), at -20.000, 0.000, 0.000 mm in the coordinate system there, is outside", said)

    def test_the_end_of_the_travel_is_inside(self):
        named = "$$! machine coord3-mc16\n" + harness.LENGTH.replace("XORIG,800", "XORIG,2.0")  # the radius of the tip
        for shift, told in (("2.0", []), ("1.9996", []), ("1.99", [("E0302", 10)])):
            self.assertEqual(self.told(named.replace("XORIG,2.0", f"XORIG,{shift}"), code=1 if told else 0), told)

    def test_folders_are_searched_for_programs(self):
        self.write("programs/a.dmi", harness.LENGTH)
        self.write("programs/deeper/b.DMI", harness.LENGTH)
        self.write("programs/note.txt", "no program")
        self.assertIn("in 2 programs", self.abbe("check", "programs").stdout)
        self.write("empty/note.txt", "no program")
        self.assertIn("empty", self.refused("E0601", "check", "empty"))

    def test_what_not_even_an_error_free_machine_can_evaluate(self):
        # A plane through a point has no extent, so that its orientation has no zone. Any machine shows it.
        constructed = "F(M)=FEAT/PLANE,CART,0,0,0,1,0,0\nF(N)=FEAT/PLANE,CART,0,0,0,1,0,0\nMEAS/PLANE,F(M),3\nPTMEAS/CART,0,0,0,1,0,0\nPTMEAS/CART,0,9,0,1,0,0\nPTMEAS/CART,0,0,9,1,0,0\nENDMES\nCONST/PLANE,F(N),PARTO,FA(M),THRU,FA(A)\nT(PA)=TOL/PARLEL,0.1,FA(M)\nOUTPUT/FA(N),TA(PA)\nENDFIL\n"
        program = harness.LENGTH.replace("ENDFIL\n", constructed).replace("XORIG,800", "XORIG,8000")
        line = program[:program.index("OUTPUT/FA(N)")].count("\n") + 1
        self.assertEqual(self.told(program), [("E0304", line)])
        help_text = json.loads(self.abbe("check", "program.dmi", "--format", "json", code=1).stdout)["messages"][0]["help"]
        self.assertIn("--only-valid", help_text)

    def test_moves_outside_the_travel_of_the_machine_that_it_names(self):
        far = harness.LENGTH.replace("ENDFIL", "GOTO/99999,0,0\nGOTO/0,0,0\nENDFIL")
        self.assertEqual(self.told("$$! machine coord3-mc16\n" + far, code=0), [("W0309", 18)])
        self.assertEqual(self.told(far, code=0), [])

    def test_touches_from_the_other_side(self):
        bore = "F(C)=FEAT/CIRCLE,{0},CART,20,20,0,0,0,1,20\nMEAS/CIRCLE,F(C),3\n" + "".join(f"PTMEAS/CART,{20 + 10 * x},{20 + 10 * y},0,{-x},{-y},0\n" for x, y in ((1, 0), (0, 1), (-1, 0))) + "ENDMES\n"
        face = "F(M)=FEAT/PLANE,CART,0,0,0,0,0,{0}\nMEAS/PLANE,F(M),3\n" + "".join(f"PTMEAS/CART,{x},{y},0,0,0,1\n" for x, y in ((0, 0), (9, 0), (0, 9))) + "ENDMES\n"
        for feature, right, wrong in ((bore, "INNER", "OUTER"), (face, "1", "-1")):
            self.assertEqual(self.told(harness.LENGTH.replace("ENDFIL\n", feature.format(right) + "ENDFIL\n"), code=0), [])
            text = harness.LENGTH.replace("ENDFIL\n", feature.format(wrong) + "ENDFIL\n")
            line = text[:text.rindex("ENDMES")].count("\n") + 1
            self.assertEqual(self.told(text, code=0), [("W0310", line)])

    def test_zones_that_the_nominal_part_does_not_fit_into(self):
        def told(*lines):
            """The messages, with the line counted from the first of these."""
            faces = ""
            for name, z in (("A", 0), ("B", -20)):
                faces += f"F({name})=FEAT/PLANE,CART,0,0,{z},0,0,1\nMEAS/PLANE,F({name}),4\nENDMES\n"
            begin = harness.LENGTH.replace("ENDFIL\n", faces + "DATDEF/FA(A),DAT(A)\n")
            text = begin + "".join(line + "\n" for line in lines) + "ENDFIL\n"
            return [(code, line - begin.count("\n")) for code, line in self.told(text, code=0)]

        self.assertEqual(told("T(T)=TOL/PARLEL,0.05,DAT(A)", "OUTPUT/FA(B),TA(T)"), [])
        self.assertEqual(told("T(T)=TOL/PERP,0.05,DAT(A)", "OUTPUT/FA(B),TA(T)"), [("W0313", 2)])
        message = json.loads(self.abbe("check", "program.dmi", "--format", "json").stdout)["messages"][0]["message"]
        self.assertEqual(message, "even of the nominal part PERP of FA(B) is 20.000 mm")
        # Of a zone of 0 only the value is asked, and a nominal that is rounded is none that lies elsewhere.
        self.assertEqual(told("T(T)=TOL/PERP,0,DAT(A)", "OUTPUT/FA(B),TA(T)"), [])
        rounded = ["F(C)=FEAT/CIRCLE,INNER,CART,30.4,0,0,0,0,1,20", "MEAS/CIRCLE,F(C),3"]
        rounded += [f"PTMEAS/CART,{x},{y},0,{i},{j},0" for x, y, i, j in ((40, 0, -1, 0), (30, 10, 0, -1), (20, 0, 1, 0))]
        self.assertEqual(told(*rounded, "ENDMES", "T(T)=TOL/POS,2D,0.05", "OUTPUT/FA(C),TA(T)"), [])

    def test_vectors_that_lie_in_the_surface(self):
        def told(feature, *touches):
            """The messages about a feature with these touches: (code, number of the touch)."""
            begin = harness.LENGTH.replace("ENDFIL\n", f"F(M)=FEAT/{feature}\nMEAS/{feature.split(',')[0]},F(M),{len(touches)}\n")
            text = begin + "".join(f"PTMEAS/CART,{touch}\n" for touch in touches) + "ENDMES\nENDFIL\n"
            return [(code, line - begin.count("\n")) for code, line in self.told(text, code=0)]

        bore, right, back = "CIRCLE,INNER,CART,0,0,0,0,0,1,20", "10,0,0,-1,0,0", "-10,0,0,1,0,0"
        self.assertEqual(told(bore, right, "0,10,0,0,-1,0", back), [])
        self.assertEqual(told(bore, right, "0,10,0,0,-0.70710678,0.70710678", back), [])
        self.assertEqual(told(bore, right, "0,10,0,0,0,1", back), [("W0312", 2)])
        self.assertEqual(told(bore, right, "0,10,0,1,0,0", "-10,0,0,0,1,0"), [("W0312", 2)])
        message = json.loads(self.abbe("check", "program.dmi", "--format", "json").stdout)["messages"][0]["message"]
        self.assertEqual(message, "the vector of touch 2 of F(M) lies 90 degrees from the normal of its surface, the first of 2 such vectors")
        # A FEAT may be a dummy: the plane is that of the touches.
        for nominal in ("0,0,1", "0,1,0"):
            self.assertEqual(told(f"PLANE,CART,0,0,0,{nominal}", "0,0,0,0,0,1", "9,0,0,0,0,1", "0,9,0,0,0,1"), [])
            self.assertEqual(told(f"PLANE,CART,0,0,0,{nominal}", "0,0,0,0,0,1", "9,0,0,0,0,1", "0,9,0,1,0,0"), [("W0312", 3)])
        # Radial vectors on a countersink are 60 degrees off.
        round_it = [(1, 0), (-0.5, 0.8660254), (-0.5, -0.8660254)]
        sink = [f"{r * c:.6f},{r * s:.6f},{z},{-c},{-s},0" for r, z in ((8.6602540, -5), (17.3205081, 0)) for c, s in round_it]
        self.assertEqual(told("CONE,INNER,CART,0,0,-10,0,0,1,120", *sink), [])
        # Of these only the vectors say how the surface lies.
        self.assertEqual(told("LINE,UNBND,CART,0,0,0,1,0,0,0,0,1", "0,0,0,1,0,0", "9,0,0,1,0,0"), [])
        self.assertEqual(told("GSURF", "0,0,0,1,0,0", "9,0,0,1,0,0", "0,9,0,1,0,0"), [])

    def test_a_ball_that_does_not_fit(self):
        bore = harness.LENGTH.replace("ENDFIL", "F(C)=FEAT/CIRCLE,INNER,CART,20,20,0,0,0,1,{}\nMEAS/CIRCLE,F(C),4\nENDMES\nENDFIL")
        self.assertEqual(self.told(bore.format(4.5), code=0), [])
        self.assertEqual(self.told(bore.format(3.9), code=0), [("W0311", 19)])

    def test_files_that_directives_name(self):
        self.assertEqual(self.told("$$ about it\n$$! machine coord3-mc61\n" + harness.LENGTH), [("E0411", 2)])
        self.assertEqual(self.told("$$! workpiece none.json\n" + harness.LENGTH), [("E0601", 1)])
        self.write("part.json", '{"schema": "abbe.workpiece/1", "name": "part", "lod_kg": 3}')
        self.assertEqual(self.told("$$! workpiece part.json\n" + harness.LENGTH), [("E0402", 1)])
        self.assertIn("part.json:1:", self.abbe("check", "program.dmi", code=1).stderr)
        self.write("part.json", '{"schema": "abbe.workpiece/1", "name": "part", "surfaces": {"C": {"offset_um": 3}}}')
        self.assertEqual(self.told("$$! machine coord3-mc16\n$$! workpiece part.json\n" + harness.LENGTH), [("E0423", 1)])

    def test_a_directive_is_given_once(self):
        self.assertEqual(self.told("$$! machine coord3-mc16 seed 1\n$$! seed 2\n" + harness.LENGTH, code=0), [("W0265", 2)])
        self.assertEqual(self.told("$$! machine coord3-mc16 machines 1\n" + harness.LENGTH), [("E0114", 1)])

    def test_an_expression_without_a_value_has_a_next_step(self):
        self.told("$$! machine coord3-mc16\n" + harness.LENGTH.replace("-0.01,0.01", "1/0,0.01"))
        self.assertIn("help: correct the numbers", self.abbe("check", "program.dmi", code=1).stderr)

    def test_directives_stand_in_the_program_not_in_a_module(self):
        self.write("module.dmi", "DMISMD/'module',5.2\n$$! wibble 1\nGOTO/1,2,3 $$! expect TA(LEN) u >= 5\n$$ no directive\nENDFIL\n")
        includes = harness.LENGTH.replace("UNITS", "INCLUD/DMIS,'module.dmi'\nUNITS")
        self.assertEqual(self.told(includes), [("E0127", 2), ("E0127", 3)])
        self.assertIn("module.dmi:2:", self.abbe("check", "program.dmi", code=1).stderr)
        self.assertEqual(self.told(includes.replace("UNITS", "INCLUD/DMIS,'module.dmi'\nUNITS")), [("E0127", 2), ("E0127", 3)])
        self.assertEqual(self.told(includes.replace("INCLUD/DMIS", "EXTFIL/DMIS")), [("E0127", 2), ("E0127", 3)])

    def test_what_such_a_machine_lacks(self):
        machine = json.loads(self.abbe("machine", "init", "mine").stdout)
        del machine["offsets_mm"]
        self.write("mine.json", json.dumps(machine | {"effects": [{"name": "probe.tipradius"}]}))
        self.assertEqual(self.told("$$! machine mine.json\n" + harness.LENGTH), [("W0417", 1), ("E0305", 1)])


harness.main()
