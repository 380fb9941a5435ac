#!/usr/bin/env python3
"""abbe repl: scripted sessions through a pipe."""
import json
import os
import subprocess
import time

import harness
from harness import LENGTH, ROOT

STATEMENTS = LENGTH.replace("ENDFIL\n", "")


class Repl(harness.Case):
    def session(self, text, *options, code=0):
        done = subprocess.run([self.abbe_path, "repl", "--machines", "50", *map(str, options)], cwd=self.folder, input=text,
                              capture_output=True, text=True, errors="replace", timeout=120)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertEqual(done.stderr, "")
        return done.stdout

    def test_output_shows_its_results_at_once_and_they_are_those_of_run(self):
        out = self.session(STATEMENTS)
        self.write("a.dmi", LENGTH)
        expected = self.run_json("a.dmi", "--machines", 50)["characteristics"][0]
        low, high = expected["interval95"]["symmetric"]
        line = [line for line in out.splitlines() if line.startswith("TA(LEN)")]
        self.assertEqual(len(line), 1, out)
        self.assertRegex(line[0], r"^TA\(LEN\) of FA\(A\), FA\(B\): 100\.0+ mm, u95 0\.0\d+ mm$")
        self.assertAlmostEqual(float(line[0].split()[-2]), (high - low) / 2, delta=0.05 * (high - low))

    def test_a_terminal_completes_the_names_of_files(self):
        (self.folder / "parts").mkdir()
        self.write("parts/one-length.dmi", LENGTH)
        self.write("parts/other.dmi", LENGTH)
        shown = self.terminal(".lo\tpa\ton\t\r.list\r.quit\r")
        self.assertIn("parts/one-length.dmi", shown)
        self.assertIn("T(LEN)=TOL", shown)
        self.assertIn("other.dmi", self.terminal(".load parts/\t\t\r.quit\r"))
        self.assertIn("OUTPUT/FA(A)", self.terminal(".load parts/other.dmi\rOUTP\t/FA(A\t\r.list\r.quit\r"))

    def test_ctrl_c_drops_the_entry_that_is_being_typed(self):
        shown = self.terminal("IF/(1 .EQ. 1)\r", ("  ... ", "GOTO/1,2\x03"), ("is dropped\r\nabbe> ", "GOTO/0,0,0\r.list\r.quit\r"))
        self.assertIn("the unfinished entry is dropped", shown)
        self.assertIn("   1  GOTO/0,0,0", shown)
        self.assertNotIn("   1  IF/", shown)

    def terminal(self, keys, *later):
        """What a session in a terminal shows when these keys are pressed; `later`: what is shown first, and the keys then."""
        master, slave = self.pseudo_terminal()
        with subprocess.Popen([self.abbe_path, "repl", "--machines", "20"], cwd=self.folder, stdin=slave, stdout=slave, stderr=slave,
                              env={**os.environ, "TERM": "xterm"}, start_new_session=True) as process:
            os.close(slave)
            shown = b""
            try:
                for first, pressed in (("abbe> ", keys), *later):
                    while first.encode() not in shown:
                        shown += os.read(master, 4096)
                    time.sleep(0.3)  # the prompt is there before the terminal is ready for single keys
                    os.write(master, pressed.encode())
                while piece := os.read(master, 4096):
                    shown += piece
            except OSError:  # the session has closed the terminal
                pass
            os.close(master)
            self.assertEqual(process.wait(60), 0, shown)
        return shown.decode(errors="replace")

    def test_only_what_is_new_is_shown(self):
        out = self.session(STATEMENTS + "T(TWO)=TOL/DISTB,NOMINL,100.0,-0.01,0.01,XAXIS\nOUTPUT/FA(A),FA(B),TA(TWO)\n")
        self.assertEqual((out.count("TA(LEN) of"), out.count("TA(TWO) of")), (1, 1))
        again = self.session(STATEMENTS + ".run\n")
        self.assertEqual(again.count("TA(LEN) of"), 2)

    def test_what_a_run_shows_of_the_program_is_told_once(self):
        out = self.session(STATEMENTS + "GOTO/99999,0,0\nOUTPUT/FA(A),FA(B),TA(LEN)\n.run\n")
        self.assertEqual(out.count("W0309"), 1, out)

    def test_an_unknown_uncertainty_is_no_zero(self):
        out = self.session(STATEMENTS + "T(RO)=TOL/CIRLTY,0.1\nF(C)=FEAT/CIRCLE,INNER,CART,0,0,0,0,0,1,50\nMEAS/CIRCLE,F(C),3\nENDMES\nOUTPUT/FA(C),TA(RO)\n")
        self.assertIn("TA(RO) of FA(C): 0.000000 mm, u95 not known\n", out)

    def test_mistakes_keep_the_session_alive(self):
        broken = STATEMENTS.replace("MEAS/POINT,F(B),1", "MAES/POINT,F(B),1\nMEAS/POINT,F(B),1").replace("T(LEN)=TOL", "T(LEN)=TLO/X\nT(LEN)=TOL")
        out = self.session(broken + "OUTPUT/FA(C),TA(LEN)\nGOTO/9000,0,0\n.undo\nOUTPUT/FA(A),FA(B),TA(LEN)\n")
        self.assertIn("E0110", out)
        self.assertIn("did you mean MEAS?", out)
        self.assertIn("session:12:1: error E0110", out)
        self.assertIn("E0201", out)
        self.assertEqual(out.count("TA(LEN) of"), 2, out)

    def test_blocks_and_cut_lines_wait_for_their_end(self):
        cut = STATEMENTS.replace("OUTPUT/FA(A),FA(B)", "OUTPUT/FA$\n(A),FA(B)")
        self.assertIn("TA(LEN) of", self.session(cut))
        self.assertIn("dropped", self.session("MEAS/POINT,F(A),1\nPTMEAS/CART,0,0,0,1,0,0\n"))
        self.assertIn("unfinished entry", self.session("MEAS/POINT,F(A),1\n.undo\n"))

    def test_a_touch_that_no_machine_can_reach_is_dropped(self):
        out = self.session(STATEMENTS.replace("MEAS/POINT,F(B)", "D(FAR)=TRANS/XORIG,80000\nMEAS/POINT,F(B)") + ".list\n")
        self.assertEqual(out.count("E0302"), 1, out)
        self.assertIn("session:14:1: error E0302", out)
        listed = out[out.index("   1  "):]
        self.assertIn("  PTMEAS/CART,0,0,0,-1,0,0\n", listed)
        self.assertNotIn("  PTMEAS/CART,100,0,0,1,0,0\n", listed)
        mended = self.session(STATEMENTS.replace("PTMEAS/CART,100,0,0,1,0,0", "PTMEAS/CART,99999,0,0,1,0,0") +
                              "MEAS/POINT,F(B),1\nPTMEAS/CART,100,0,0,1,0,0\nENDMES\nOUTPUT/FA(A),FA(B),TA(LEN)\n")
        self.assertEqual(mended.count("TA(LEN) of"), 1, mended)

    def test_what_a_directive_names_is_read_at_once(self):
        out = self.session("$$! machine nope\n$$! workpiece none.json\n.list\n")
        self.assertIn("session:1:13: error E0411", out)
        self.assertIn("session:1:15: error E0601", out)
        self.assertIn("nothing has been entered", out)

    def test_a_machine_that_cannot_do_what_was_entered_is_not_taken(self):
        out = self.session(STATEMENTS.replace("ZORIG,-700", "ZORIG,-1050") + ".machine precision-500\n.run\n")
        self.assertIn("error E0302", out)
        self.assertIn("the machine is still coord3-mc16", out)
        self.assertEqual(out.count("TA(LEN) of"), 2, out)
        self.write("far.dmi", LENGTH.replace("XORIG,800", "XORIG,80000"))
        self.assertIn("was not loaded", self.session(".load far.dmi\n"))

    def test_a_mistake_in_another_place_is_told(self):
        out = self.session("M(A)=MACRO/X\nGOTO/X,0,0\nENDMAC\nCALL/M(A),'text'\n.list\n")
        self.assertIn("session:2:6: error E0106", out)
        self.assertNotIn("  CALL/", out)
        self.write("inc.dmi", "FOO/BAR\n")
        out = self.session(STATEMENTS + "INCLUD/DMIS,'inc.dmi'\n.list\n")
        self.assertIn("inc.dmi:1:1: error E0110", out)
        self.assertNotIn("  INCLUD/", out)

    def test_a_warning_is_told_once(self):
        self.assertEqual(self.session("X=ASSIGN/1\nY=ASSIGN/X\nX=ASSIGN/2\n").count("W0124"), 2)

    def test_a_macro_that_evaluates_shows_its_results(self):
        out = self.session(STATEMENTS.replace("OUTPUT", "M(O)=MACRO/'X'\nOUTPUT") + "ENDMAC\nCALL/M(O),F(A)\nCALL/M(O),F(A)\n")
        self.assertEqual(out.count("TA(LEN) of"), 2, out)

    def test_a_jump_waits_for_its_target(self):
        loop = "I=ASSIGN/0\n(AGAIN)\nI=ASSIGN/I+1\nIF/(I .GT. 3)\nJUMPTO/(DONE)\nENDIF\nJUMPTO/(AGAIN)\n(DONE)\n"
        out = self.session("DECL/INTGR,I\n" + loop + STATEMENTS[STATEMENTS.index("\n") + 1:] + ".save loop.dmi\n")
        self.assertNotIn("error E", out)
        self.assertEqual(out.count("TA(LEN) of"), 1)
        self.assertEqual(len(self.run_json("loop.dmi", "--machines", 50)["characteristics"]), 1)
        out = self.session("JUMPTO/()\nJUMPTO/(L)\n.list\n.save open.dmi\n(L)\n(L)\n.save closed.dmi\n")
        self.assertIn("   1  JUMPTO/(L)\n", out)
        self.assertIn("E0106", out)
        self.assertIn("open.dmi written\nsession:1:1: error E0233: there is no target (L)", out)
        self.assertIn("E0246", out)
        self.assertTrue(out.endswith("closed.dmi written\n"), out)

    def test_undo_list_save_and_load(self):
        out = self.session(STATEMENTS + ".undo\n.list\n.save saved.dmi\n.quit\nnever read\n")
        self.assertIn("taken back: OUTPUT/FA(A),FA(B),TA(LEN)", out)
        self.assertEqual((self.folder / "saved.dmi").read_text(), LENGTH.replace("OUTPUT/FA(A),FA(B),TA(LEN)\n", ""))
        out = self.session("OUTPUT/FA(A),FA(B),TA(LEN)\n.save\n", "saved.dmi")
        self.assertIn("TA(LEN) of", out)
        self.assertEqual((self.folder / "saved.dmi").read_text(), LENGTH)
        self.assertIn("1 characteristic", self.session(".load saved.dmi\n"))
        self.assertIn("nothing has been entered", self.session(".undo\n.list\n"))

    def test_options_that_cannot_be_used_end_it_at_once(self):
        for code, *options in (("E0411", "--machine", "nosuch"), ("E0603", "--machines", 0), ("E0601", "--workpiece", "nofile"), ("E0603", "--threads", -3)):
            self.refused(code, "repl", *options)

    def test_a_program_with_errors_is_not_loaded(self):
        self.write("wrong.dmi", LENGTH.replace("T(LEN)=TOL", "T(LEN)=TLO"))
        out = self.session(".load wrong.dmi\n.list\n")
        self.assertIn("wrong.dmi:15:8: error E0110", out)
        self.assertIn("was not loaded", out)
        self.assertIn("nothing has been entered", out)

    def test_what_is_saved_can_be_run(self):
        self.session("\n".join(STATEMENTS.splitlines()[1:]) + "\n.save part.dmi\n")
        self.assertEqual(len(self.run_json("part.dmi", "--machines", 50)["characteristics"]), 1)

    def test_sensors_are_compared(self):
        sensors = "S(SHORT)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\nS(LONG)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,400,4\nS(SIDE)=SNSDEF/PROBE,INDEX,POL,90,0,0,0,-1,200,4\n"
        out = self.session(sensors + ".sensor\n.compare S(LONG) short\n")
        table = {line.split()[0]: line.split()[1:] for line in out.splitlines() if line.startswith(("SHORT  ", "LONG  ", "SIDE  "))}
        self.assertEqual([float(x) for x in table["SHORT"][:3]], [0, 0, -100])
        self.assertEqual([float(x) for x in table["LONG"][:3]], [0, 0, -400])
        self.assertEqual(float(table["SIDE"][2]), 0)
        for row in table.values():
            self.assertTrue(all(float(x) > 0 for x in row[3:]), row)
        ratios = next(line for line in out.splitlines() if line.startswith("SHORT / LONG")).split()[3:]
        lengths = [float(table[name][6]) for name in ("SHORT", "LONG")]
        self.assertAlmostEqual(float(ratios[0]), lengths[0] / lengths[1], delta=0.03)

    def test_what_never_varies_has_no_ratio(self):
        machine = json.loads((ROOT / "examples/machines/coord3-mc16.json").read_text())
        del machine["head"]
        machine["probe"]["sd_um"] = [0, 0, 0]
        machine["specification"]["v_max"] = "unlimited"
        for component in machine["geometry"]["components"].values():
            component["e_max"] = 0
        self.write("perfect.json", json.dumps(machine))
        sensors = "S(A)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\nS(B)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,400,4\n"
        out = self.session(sensors + ".compare A B\n", "--machine", "perfect.json")
        ratios = next(line for line in out.splitlines() if line.startswith("B / A")).split()[3:]
        self.assertEqual(ratios[:3], 3 * ["-"])
        # With the scatter of the probe alone a length has that of its two touches: 1.96 times the root of 2 times 0.5 um are 1.39 um.
        # Of 50 machines the half of the interval is known to some 15 %: it is neither the whole nor another unit.
        machine["probe"]["sd_um"] = [0.5, 0.5, 0.5]
        self.write("scatters.json", json.dumps(machine))
        out = self.session("S(A)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\n.sensor A\n", "--machine", "scatters.json")
        row = next(line.split() for line in out.splitlines() if line.startswith("A "))
        for u95_um in row[7:10]:
            self.assertAlmostEqual(float(u95_um), 1.39, delta=0.6)

    def test_levers_are_those_of_the_machine(self):
        # At mid travel the tip of the lever of Z stands across Z by the mount's offset and the tip's: mount (25, 40), machine file.
        out = self.session("S(P)=SNSDEF/PROBE,FIXED,CART,30,0,-100,0,0,-1,4\n.sensor P\n")
        row = next(line.split() for line in out.splitlines() if line.startswith("P "))
        self.assertEqual(row[6], "68")  # hypot(25 + 30, 40) = 68.0

    def test_commands_that_make_no_sense(self):
        out = self.session(".halp\n.compare A\n.sensor NONE\n.load none.dmi\n.machine none\n.machines few\n.save\n.machines 60\n.help\nENDFIL\n")
        for expected in ("E0612", "did you mean .help?", "E0613", "E0614", "E0601", "E0411", "60 virtual machines", ".compare A B", ".save writes"):
            self.assertIn(expected, out)

    def test_the_machine_can_be_chosen(self):
        self.assertIn("machine coord3-mc16: travel 1600 x 1000 x 800 mm", self.session(".machine coord3-mc16\n"))
        portal = ROOT / "examples/iso10360/portal-2009.json"
        self.assertIn("machine portal", self.session(f".machine {portal}\n"))


if __name__ == "__main__":
    harness.main()
