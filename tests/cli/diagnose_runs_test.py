"""abbe diagnose on several runs of one program: what differs between them."""
import json
import math
import random

import harness

PROGRAM = harness.ROOT / "examples/iso10360/form_and_size_5x25.dmi"   # one sphere, five orientations of the head, 125 touches
MACHINE = harness.ROOT / "examples/iso10360/portal-2009.json"
BALL = harness.ROOT / "examples/programs/sphere_25_points.dmi"


class DiagnoseRuns(harness.Case):
    def record(self, run, *options, whole=False):
        """Of a part of PROGRAM, unless it is to be the whole."""
        name = f"run{run}.csv"
        self.abbe("record", PROGRAM if whole else self.sphere(), "--machine", MACHINE, "--run", run, "-o", name, *options)
        return name

    def balls(self, runs, changed):
        """Recordings of a ball in so many runs; in one of them with what `changed` has for it."""
        names = [f"run{run}.csv" for run in range(1, runs + 1)]
        for run, name in enumerate(names, 1):
            self.abbe("record", BALL, "--machine", MACHINE, "--run", run, "-o", name, *(("--with", changed[run]) if run in changed else ()))
        return names

    def days_later(self, name, days):
        return self.changed(self.folder / name, lambda row: row | {"time_s": str(float(row["time_s"]) + 86400 * days)}, f"day_{days}_{name}")

    def diagnosis(self, *args):
        return json.loads(self.abbe("diagnose", *args, "--machine", MACHINE, "--format", "json").stdout)

    def test_runs_of_a_machine_in_order_agree(self):
        said = self.diagnosis(self.record(1, "--seed", 7), self.record(2, "--seed", 7))
        self.assertEqual((said["verdict"], said["touches"]), ("no_mismatch", 130))
        self.assertGreater(said["p_value"], 0.01)

    def test_what_changed_predicts_touches_left_out_however_large_it_is(self):
        """By the noise and the errors of the whole recording: those that a part of it asks for may be others altogether. And corrected by one
        account of the change: as there since the second run, or gone since the first."""
        part = harness.ROOT / "examples/programs/prismatic_part.dmi"
        self.abbe("record", part, "-o", "before.csv")
        gains = []
        for urad in (35, 40):
            self.abbe("record", part, "--run", 2, "--with", f"machine.squareness:squareness_urad={urad},which=cwy", "-o", "after.csv")
            said = json.loads(self.abbe("diagnose", "before.csv", "after.csv", "--format", "json").stdout)
            gains.append(said["improvement"]["log_score_gain"])
            self.assertEqual([e["members"] for e in said["effects"]], [["machine.squareness"]])
            self.assertGreater(said["effects"][0]["probability"], 0.99)
            self.assertLess(said["improvement"]["chi2_per_dof"]["after"], 1.5)
        self.assertTrue(30 < gains[0] < gains[1], gains)

    def test_a_run_that_scatters_is_no_tip_that_came_and_went(self):
        """Each touch is made once in it, so that a form of the tip, drawn anew for it, explains all of its scatter; nor do the others scatter with it."""
        for runs, noisy in ((6, 4), (3, 2)):
            names, draw = self.balls(runs, {}), random.Random(runs)

            def scattered(row):
                off = draw.gauss(0, 0.004)
                return row | {p + a: f"{float(row[p + a]) + off * float(row['n' + a]):.7f}" for a in "xyz" for p in ("", "enc_")}
            names[noisy - 1] = self.changed(self.folder / names[noisy - 1], scattered, "scattered.csv")
            said = self.diagnosis(*names)
            self.assertEqual([e["members"] for e in said["effects"]], [["noise.unequal"]])
            for words in (f"Touches of run {noisy} scatter", "Repeats of the same touches within that run would tell", "a simulated program, which has no runs, gets none of it"):
                self.assertIn(words, said["effects"][0]["sentence"])

    def test_between_two_files_styli_may_have_been_qualified_anew(self):
        """A service qualifies them all: offsets of 0.3 um by orientation. At 1 % two alarms in four come by chance once in 1700 times."""
        alarms = 0
        for seed in range(4):
            draw = random.Random(seed)
            offsets = {}

            def qualified_anew(row):
                offset = offsets.setdefault((row["head_A_deg"], row["head_B_deg"]), [draw.gauss(0, 0.0003) for _ in "xyz"])
                along = sum(o * float(row[n]) for o, n in zip(offset, ("nx", "ny", "nz")))
                return row | {c: f"{float(row[c]) + along * float(row['n' + c]):.7f}" for c in "xyz"} | {"setup": "2"}

            first, second = self.record(1, "--seed", seed), self.record(2, "--seed", seed)
            alarms += self.diagnosis(first, self.changed(self.folder / second, qualified_anew, "anew.csv"))["verdict"] != "no_mismatch"
        self.assertLessEqual(alarms, 1)

    def test_a_repeat_without_a_number_of_its_own_is_a_further_run(self):
        first, second = self.record(1, "--seed", 2), self.record(2, "--seed", 2)
        unnumbered = self.changed(self.folder / second, lambda row: row | {"run": "1"}, "unnumbered.csv")
        said = self.diagnosis(first, unnumbered)
        numbered = self.diagnosis(first, second)
        for key in ("verdict", "p_value", "touches", "baseline"):
            self.assertEqual(said[key], numbered[key], key)
        told = "its runs are counted on: run 1 counts as 2"
        few = lambda row: row if row["feature"].endswith(("_1", "_6", "_8")) else None   # a plan is judged by all of its touches
        first = self.changed(self.folder / first, few, "few.csv")
        said_of = lambda changed, name: self.abbe("diagnose", first, self.changed(self.changed(unnumbered, few, "short.csv"), changed, name), "--machine", MACHINE, "--design-only").stderr
        self.assertIn(told, said_of(lambda row: row, "same.csv"))
        self.assertIn(told, said_of(lambda row: row | {"feature": row["feature"].lower()}, "lower.csv"))
        self.assertNotIn(told, said_of(lambda row: row | {"setup": "2"}, "placed_anew.csv"))

    def test_what_was_done_to_several_files_is_told_once(self):
        """Of n files without run numbers n - 1 notes said the same."""
        files = [self.changed(self.folder / self.record(n, "--seed", 2), lambda row: row | {"run": "1"} if row["feature"].endswith(("_1", "_6", "_8")) else None, f"file{n}.csv") for n in (1, 2, 3, 4)]
        said = self.abbe("diagnose", *files, "--machine", MACHINE, "--design-only").stderr
        self.assertEqual(said.count("N0708"), 2, said)
        self.assertEqual(said.count("so it is with 2 files more"), 2, said)

    def days(self, touches=3):
        """So many touches on each of three days of one clock, numbered by nobody; with three they are too few to be judged, and what is said of files is said first."""
        program, files = BALL, []
        for day in (1, 2, 3):
            self.abbe("record", program, "--machine", MACHINE, "--run", day, "-o", f"run{day}.csv")
            files.append(self.changed(self.folder / f"run{day}.csv", lambda row: row | {"run": "1", "time_s": str(float(row["time_s"]) + 86400 * day)}
                                      if int(row["touch"]) <= touches else None, f"day{day}.csv"))
        return files

    def said_of(self, *files):
        return self.refused("E0705", "diagnose", *files, "--machine", MACHINE)

    def test_files_in_another_order_count_in_that_of_their_clocks(self):
        """Runs were numbered in the order given, and a change that came on the last day came and went and came."""
        first, second, third = self.days()
        told = "in another order than they were measured in"
        said = self.said_of(third, first, second)
        self.assertIn(told, said)
        self.assertRegex(said, "day2.csv: it repeats touches .*: run 1 counts as 2; so it is with 1 file more")
        clock = lambda begin: lambda row: row | {"time_s": str(float(row["time_s"]) % 86400 + begin)}
        evening, morning = (self.changed(f, clock(begin), f"{begin}.csv") for f, begin in ((first, 85000), (second, 600)))
        anew = [self.changed(f, clock(0), f"anew_{f.name}") for f in (third, first, second)]
        for files in ((first, second, third), (evening, morning), anew):
            self.assertNotIn(told, self.said_of(*files))

    def test_files_whose_clocks_began_anew_count_in_the_order_of_their_runs(self):
        """As after*.csv before*.csv gives them: a step in the second run had been there before the first."""
        before, after = self.balls(2, {2: "probe.step:amplitude_um=5,t0_s=30,direction=x"})
        given = self.abbe("diagnose", after, before, "--machine", MACHINE, "--format", "json")
        self.assertIn("by the numbers of their runs the files are given in another order", given.stderr)
        right, said = self.diagnosis(before, after), json.loads(given.stdout)
        for key in ("effects", "p_value", "location"):
            self.assertEqual(said[key], right[key], key)

    def test_what_two_files_have_in_common_counts_once(self):
        """Two exports that overlap, the second day in both: its clock was taken for one that began anew, and all of it for repeats."""
        first, second, third = (self.changed(f, lambda row, day=day: row | {"run": str(day)}, f"numbered{day}.csv") for day, f in enumerate(self.days(), 1))
        body = lambda path: "".join(line + "\n" for line in path.read_text().splitlines() if not line.startswith(("#", "feature")))
        early, late = self.write("early.csv", first.read_text() + body(second)), self.write("late.csv", second.read_text() + body(third))
        said = self.said_of(early, late)
        self.assertIn("late.csv: 3 of its rows stand in the files ahead of it too", said)
        self.assertNotIn("N0708", said)
        self.assertIn("too few touches to judge a machine by: 9", said)
        head = second.read_text().removesuffix(body(second))
        pieces = self.write("pieces.csv", head + body(second).splitlines()[-1] + "\n" + body(third).splitlines()[0] + "\n")   # nothing is left of it
        self.assertIn("too few touches to judge a machine by: 9", self.said_of(first, second, third, pieces))

    def test_one_file_in_another_unit_is_told_by_its_name(self):
        """It was taken for a tip that is 28 mm too small, or for touches beyond the travel."""
        first, second, third = self.days(12)
        for columns, told in (("x y z", "inches.csv: the recorded positions are in inches"),
                              ("x y z tx ty tz", "inches.csv: positions and targets are in inches, those of the same touches in")):
            inches = self.changed(second, lambda row: row | {c: f"{float(row[c]) / 25.4:.7f}" for c in columns.split()}, "inches.csv")
            for files in ((first, inches, third), (inches, first, third)):
                self.assertIn(told, self.refused("E0701", "diagnose", *files, "--machine", MACHINE).replace(str(self.folder) + "/", ""))

    def test_numbers_that_are_too_large_to_count_on_are_told(self):
        first = self.folder / self.record(1)

        def copies(column, **numbers):
            """Repeats of the first recording, in so many files that their numbers add up to more than a computer's integers hold."""
            for k in range(23):
                def repeat(row):
                    return row | {"x": f"{float(row['x']) + 1e-5 * k:.7f}"} | {name: str(number(k, row)) for name, number in numbers.items()}

                yield self.changed(first, repeat, f"{column}{k}.csv")

        large = {"run": {"run": lambda k, row: 1 if row["feature"].endswith("_24") else 10**8}, "qualification": {"run": lambda k, _: k + 1, "qualification": lambda k, _: 10**8 if k else ""}}
        for column, numbers in large.items():
            with self.subTest(column=column):
                said = self.refused("E0707", "diagnose", *copies(column, **numbers), "--machine", MACHINE, "--design-only")
                self.assertIn(f"its numbers in the column '{column}'", said)

    def test_a_part_that_was_moved_between_runs_of_one_setup_is_thought_of(self):
        """Of what is new in a run its sentence says it, of a pattern what to do next; and nobody says it twice."""
        first, second = self.record(1, "--seed", 3, whole=True), self.record(2, "--seed", 3, whole=True)
        for by_mm in (0.1, 0.004):
            moved = self.changed(self.folder / second, lambda row: row | {
                "x": repr(float(row["x"]) + by_mm), "z": repr(float(row["z"]) + (by_mm < 0.1) * by_mm / 100 * float(row["x"])),
                "time_s": repr(float(row["time_s"]) + 5000)}, "moved.csv")
            told = self.abbe("diagnose", first, moved, "--machine", MACHINE).stdout
            self.assertEqual(told.count("different setups"), 1, told)
        anew = self.changed(moved, lambda row: row | {"setup": "2"}, "placed.csv")
        self.assertNotIn("different setups", self.abbe("diagnose", first, anew, "--machine", MACHINE).stdout)

    def test_a_part_placed_anew_is_measured_anew(self):
        """The noise of the first placement came again, and the second one looked impossibly alike."""
        for seed in (1, 2):
            first, second = self.record(1, "--seed", seed), "placed.csv"
            self.abbe("record", self.sphere(), "--machine", MACHINE, "--seed", seed, "--setup", 2, "-o", second)
            said = self.diagnosis(first, second)
            self.assertEqual((said["verdict"], said["touches"]), ("no_mismatch", 130))

    def test_runs_in_one_file_are_those_of_two(self):
        """Each has a clock that begins at 0."""
        first, second = self.record(1), self.record(2, "--with", "machine.step:amplitude_um=10,t0_s=100")
        lines = (self.folder / second).read_text().splitlines()
        rows = [line for line in lines if not line.startswith("#")][1:]
        (self.folder / "both.csv").write_text((self.folder / first).read_text() + "\n".join(rows) + "\n")
        apart, together = self.diagnosis(first, second), self.diagnosis("both.csv")
        for said in (apart, together):
            self.assertIn("N0708", [m["code"] for m in said["messages"]])
        self.assertEqual(apart["effects"][0]["members"], together["effects"][0]["members"])
        self.assertEqual(apart["verdict"], together["verdict"])
        self.assertEqual(apart["location"][0]["where"], together["location"][0]["where"])

    def test_copies_are_no_repeats_whatever_they_are_called(self):
        first = self.folder / self.record(1)
        for number in ({"run": "2"}, {"setup": "2"}, {"setup": "2", "run": "2"}):
            said = self.refused("E0713", "diagnose", first, self.changed(first, lambda row: row | number, "copied.csv"))
            self.assertIn("'copied.csv' holds the same touches as", said.replace(str(self.folder) + "/", ""))
            self.assertIn("to the last digit", said)
        few = lambda row: row | {"run": "2"} | ({"x": repr(float(row["x"]) + 1e-4)} if row["touch"] == "3" else {})
        self.refused("E0713", "diagnose", self.changed(first, few, "few.csv"), first)
        first = self.changed(first, lambda row: row if row["head_A_deg"] == "0.0000" else None, "short.csv")   # a plan is judged by all of its touches
        coarse = lambda row: row | {a: f"{float(row[a]):.2f}" for a in "xyz"} | {f"enc_{a}": "" for a in "xyz"}
        again = self.changed(self.changed(first, coarse, "one.csv"), lambda row: row | {"run": "2"}, "two.csv")
        self.abbe("diagnose", "one.csv", again, "--machine", MACHINE, "--design-only")   # two decimals repeat by themselves
        plan = lambda run: lambda row: row | {a: row["t" + a] for a in "xyz"} | {"run": run}
        self.abbe("diagnose", self.changed(first, plan("1"), "plan.csv"), self.changed(first, plan("2"), "again.csv"), "--machine", MACHINE, "--design-only")

    def test_what_is_said_of_files_stands_in_the_answer_too(self):
        first, second = self.record(1), self.folder / self.record(2)
        windows = self.changed(second, lambda row: row | {"run": "1"}, "windows.csv")
        windows.write_bytes("# Prüfer: Müller\n".encode("cp1252") + windows.read_bytes())
        done = self.abbe("diagnose", first, windows, "--known", MACHINE, "--design-only", "--format", "json", "--report", "page.html")
        codes = [m["code"] for m in json.loads(done.stdout)["messages"]]
        for code in ("N0617", "N0708", "W0715"):
            self.assertIn(code, codes)
            self.assertEqual(codes.count(code), done.stderr.count(code), code)
            self.assertIn(code, (self.folder / "page.html").read_text())

    def test_another_machine_than_the_known_one_is_told(self):
        """Sixteen balls all over the volume: what the first recording left uncertain is far less than what two machines differ by."""
        points = [(0, 0, 1)] + [(math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))
                                for e, first in ((math.pi / 4, 0), (math.pi / 18, math.pi / 4)) for a in (first + k * math.pi / 2 for k in range(4))]
        centres = [(x, y, z) for z in (-600, -350) for y in (250, 750) for x in (250, 550, 850, 1150)]
        program = self.write("balls.dmi", harness.balls(centres, points))
        for name, seed, run in (("first.csv", 1, 1), ("same.csv", 1, 2), ("other.csv", 2, 2)):
            self.abbe("record", program, "--machine", MACHINE, "--seed", seed, "--run", run, "-o", name)
        self.abbe("diagnose", "first.csv", "--machine", MACHINE, "--model-out", "known.json")
        same = self.known("same.csv", code=0)
        self.assertEqual((same["verdict"], same["times_known_uncertainty"]), ("no_mismatch", None))
        self.assertLess(same["baseline"]["geometry_scale"], 2)
        other = self.known("other.csv", code=1)
        self.assertGreater(other["times_known_uncertainty"], 3)
        self.assertIn("W0720", [m["code"] for m in other["messages"]])
        told = self.abbe("diagnose", "other.csv", "--known", "known.json").stdout
        self.assertIn("not the machine that its file knows", told)
        self.assertNotIn("That does not mean that nothing is there", told)

    def known(self, recording, code):
        return json.loads(self.abbe("diagnose", recording, "--known", "known.json", "--fail-on-mismatch", "--format", "json", code=code).stdout)

    def test_the_noise_of_one_place_is_no_period_of_the_scale(self):
        """One point touched 30 times: the readings differ by the noise of the touches and nothing else."""
        head, point = harness.LENGTH.split("F(A)=", 1)
        point = "F(A)=" + point.split("F(B)=")[0]
        program = self.write("repeats.dmi", head + "".join(point.replace("(A)", f"(A{k})") for k in range(30)) + "ENDFIL\n")
        accused = []
        for seed in range(1, 7):
            self.abbe("record", program, "--machine", "coord3-mc16", "--seed", seed, "-o", "repeats.csv")
            said = json.loads(self.abbe("diagnose", "repeats.csv", "--format", "json").stdout)
            accused += [e["members"] for e in said["effects"]]
        self.assertNotIn("machine.scale_interpolation", sum(accused, []))
        self.assertLessEqual(len(accused), 1)   # seed 3 looks like a step by chance: 0.3 %

    def test_what_is_new_in_a_run_is_named_as_new(self):
        """A step of the indexing head between the runs would fit this well too, if effects were the same in all runs."""
        recordings = self.record(1, whole=True), self.record(2, "--with", "machine.squareness:squareness_urad=30,which=cwy", whole=True)
        said = self.diagnosis(*recordings, "--model-out", "now.json")
        self.assertEqual([(e["members"], e["new_in_run"]) for e in said["effects"]], [(["machine.squareness"], [2])])
        low, high = said["effects"][0]["parameters"]["squareness_urad"]["interval95"]
        self.assertTrue(low < 30 < high, (low, high))
        again = self.diagnosis(*reversed(recordings))   # which is new is said by the number of the run, not by the order of the files
        self.assertEqual([(e["members"], e["new_in_run"]) for e in again["effects"]], [(["machine.squareness"], [2])])
        self.assertEqual(said["location"][0]["factor"], "run")
        self.assertEqual(said["location"][0]["where"], {"run": "2"})
        # The machine file is that of the machine as it is since then.
        now = json.loads((self.folder / "now.json").read_text())
        self.assertEqual([e["name"] for e in now["effects"]], ["machine.squareness"])
        self.assertRegex(said["effects"][0]["sentence"], r"What is new in run 2 is explained by two axes not square: squareness \d+\.\d+ ± \d+\.\d+ urad")

    def test_runs_that_are_numbered_against_the_clock_are_told(self):
        """The number won in silence: what was new was gone, and no machine file had it."""
        first, second = self.days()[:2]
        numbered = [self.changed(f, lambda row, run=run: row | {"run": run}, f"{run}_{f.name}") for f, run in ((first, "2"), (second, "1"))]
        told = "by the clock its runs were made in the order 2, 1; what is new in a run, or gone, goes by their numbers"
        self.assertIn(told, self.said_of(*numbered))
        self.assertNotIn("in the order", self.said_of(first, second))

    def test_what_is_gone_after_a_run_is_told(self):
        """A tip that was dirty until it was cleaned: no machine file needs it."""
        recordings = self.balls(4, {1: "probe.tip_radius:amplitude_um=4"})
        said = self.diagnosis(*recordings, "--model-out", "now.json")
        self.assertEqual(len(said["effects"]), 1, said["effects"])
        found = said["effects"][0]
        self.assertIn("probe.tip_radius", found["members"])
        self.assertEqual(found["gone_in_run"][found["members"].index("probe.tip_radius")], 2)
        self.assertIn("what is gone in run 2", found["sentence"].lower())
        self.assertNotIn("W0737", [m["code"] for m in said["messages"]])   # nothing is missing from it
        self.assertEqual(json.loads((self.folder / "now.json").read_text()).get("effects", []), [])

    def test_what_came_and_went_is_one_thing(self):
        """The machine file was told two effects, one in the place of the other, of a machine that had neither any more."""
        recordings = self.balls(3, {2: "probe.pretravel_lobing:amplitude_um=1.5"})
        said = self.diagnosis(*recordings, "--model-out", "now.json")
        self.assertEqual([(e["members"], e["new_in_run"], e["gone_in_run"]) for e in said["effects"]],
                         [(["probe.pretravel_lobing"], [2], [3])])
        self.assertIn("What is new in run 2 and gone in run 3 is explained by", said["effects"][0]["sentence"])
        # No other run shows what was in this one: its touches are predicted from each other.
        improvement = said["improvement"]
        self.assertEqual(improvement["scheme"], "leave-one-fifth-out")
        self.assertGreater(improvement["bias_um"]["before"], 0.5)
        self.assertLess(abs(improvement["bias_um"]["after"]), improvement["bias_um"]["before"] / 3)
        self.assertNotIn("W0737", [m["code"] for m in said["messages"]])   # nothing is missing from it
        self.assertEqual(json.loads((self.folder / "now.json").read_text()).get("effects", []), [])

    def test_what_slipped_within_a_run_and_was_mended_before_the_next(self):
        recordings = self.balls(3, {2: "probe.step:amplitude_um=5,t0_s=30,direction=x"})
        found, = self.diagnosis(*recordings)["effects"]
        at = found["members"].index("probe.step")
        self.assertEqual((found["new_in_run"][at], found["gone_in_run"][at]), (None, 3))
        low, high = found["parameters"]["amplitude_um"]["interval95"]
        self.assertTrue(low < 5 < high, (low, high))
        self.assertIn("(in run 2)", found["sentence"])

    def test_a_delay_shows_at_another_speed_than_that_of_the_qualification(self):
        """It was told as new in the run at that speed, and too small: as a delay that grew, which would show at any speed."""
        def run(number, speed):
            text = BALL.read_text().replace("D(SPHERE)=", f"FEDRAT/MESVEL,MMPS,{speed}\nD(SPHERE)=")
            self.abbe("record", self.write(f"at{speed}.dmi", text), "--machine", MACHINE, "-o", f"run{number}.csv", "--run", number, "--seed", 4,
                      "--with", "probe.trigger_delay:delay_ms=0.8,qualified_at_mm_s=8")
            return f"run{number}.csv"
        said = self.diagnosis(run(1, 8), run(2, 8), run(3, 3))
        found, = said["effects"]
        self.assertEqual((found["members"][0], found["new_in_run"][0]), ("probe.trigger_delay", None))
        self.assertEqual(found["parameters"]["qualified_at_mm_s"]["value"], 8)
        low, high = found["parameters"]["delay_ms"]["interval95"]
        self.assertTrue(low < 0.8 < high, (low, high))

    def test_of_many_runs_it_is_found_in_which_something_is_new(self):
        """Nine later runs are judged in eight stretches first; the tenth run begins none of them."""
        recordings = self.balls(10, {10: "probe.tip_radius:amplitude_um=8"})
        said = self.diagnosis(*recordings)
        self.assertIn("probe.tip_radius", said["effects"][0]["members"])
        self.assertEqual(set(said["effects"][0]["new_in_run"]), {10})

    def test_scatter_is_noise_where_repeats_show_it(self):
        shaking = ("--with", "noise.unequal:ratio=5,group=1")
        first, second = self.record(1, *shaking, whole=True), self.record(2, *shaking, whole=True)
        for recordings, certain in (((first,), False), ((first, second), True)):
            said = self.diagnosis(*recordings)
            self.assertEqual([e["members"] for e in said["effects"]], [["noise.unequal"]])
            self.assertEqual(said["effects"][0]["probability"] > 0.5, certain)
            self.assertEqual("Repeats of the same touches would tell" in said["effects"][0]["sentence"], not certain)

    def test_what_has_only_a_spread_is_believed_by_half(self):
        loose = ("--with", "head.reindexing:sd_urad=60")
        said = self.diagnosis(*(self.record(run, *loose) for run in (1, 2, 3)))
        self.assertEqual(said["effects"][0]["members"], ["head.reindexing"])
        self.assertEqual(said["effects"][0]["probability"], 0.5)
        self.assertIn("It has no law but a spread, and much else looks like that. What would tell: several visits", said["effects"][0]["sentence"])

    def test_one_orientation_that_scatters_more_is_found(self):
        loose = ("--with", "noise.unequal:ratio=4,group=3,head_a_deg=90,head_b_deg=90")
        said = self.diagnosis(self.record(1, *loose, whole=True), self.record(2, *loose, whole=True))
        self.assertEqual([e["members"] for e in said["effects"]], [["noise.unequal"]])
        told = said["effects"][0]["parameters"]
        self.assertEqual([told[p]["value"] for p in ("group", "head_a_deg", "head_b_deg")], ["one orientation", 90, 90])
        self.assertLess(abs(told["ratio"]["value"] - 4), 1)
        self.assertIn("Touches with the head at A 90.0 B 90.0 scatter", said["effects"][0]["sentence"])

    def test_much_scatter_of_one_orientation_is_no_dirt(self):
        """Its farthest touches are outliers, and all of one tip."""
        said = self.diagnosis(self.record(1, "--seed", 5, "--with", "noise.unequal:ratio=6,group=3,head_a_deg=90,head_b_deg=180", whole=True))
        self.assertEqual([e["members"] for e in said["effects"]], [["noise.unequal"]])
        self.assertEqual(said["effects"][0]["parameters"]["head_b_deg"]["value"], 180)
        self.assertEqual(said["location"][0]["where"], {"head": "A 90.0 B 180.0"})
        self.assertEqual(said["baseline"]["outliers"], [])

    def test_what_shook_the_machine_for_a_while_is_told_with_when(self):
        """A quarter of the touches, of three orientations: their scatter is no dirt and no pattern."""
        said = self.diagnosis(self.record(1, "--seed", 5, "--with", "noise.unequal:ratio=6,group=7,from_s=60,to_s=110"))
        self.assertEqual([e["members"] for e in said["effects"]], [["noise.unequal"]])
        told = {name: parameter["value"] for name, parameter in said["effects"][0]["parameters"].items()}
        self.assertEqual(told["group"], "a stretch of time")
        self.assertLess(abs(told["from_s"] - 60), 15)
        self.assertLess(abs(told["to_s"] - 110), 15)
        self.assertEqual((said["location"][0]["factor"], said["baseline"]["outliers"]), ("time", []))
        text = self.abbe("diagnose", "run1.csv", "--machine", MACHINE).stdout
        self.assertIn("Find out what was different then", text)

    def test_a_pattern_finer_than_any_effect_repeats_and_is_no_noise(self):
        """Every touched point is off by its own amount, the same in both runs; the scale readings do not know of it."""
        recordings = []
        for run in (1, 2):
            point = random.Random(5)

            def off(row):
                by = point.gauss(0, 0.003) * (row["head_A_deg"] != "0.0000")
                return row | {a: f"{float(row[a]) + by * float(row['n' + a]):.7f}" for a in "xyz"}

            recordings.append(self.changed(self.folder / self.record(run), off, f"points{run}.csv"))
        said = self.diagnosis(*recordings)
        self.assertEqual((said["verdict"], said["effects"], said["unexplained"]["factor"]), ("unexplained", [], "feature"))

    def test_points_that_nothing_is_compared_with_are_not_quiet(self):
        """Of unknown surfaces only what was touched twice tells anything; the other touches fit whatever they are."""
        for seed in range(3):
            whole = self.record(1, "--seed", seed)
            again = self.changed(self.folder / self.record(2, "--seed", seed), lambda row: row if row["head_A_deg"] == "0.0000" else None, "again.csv")
            unknown = self.write("unknown.csv", "# surfaces: unknown\n" + (self.folder / whole).read_text())
            said = self.diagnosis(unknown, again)
            self.assertEqual((said["verdict"], said["effects"], said["touches"]), ("no_mismatch", [], 78), seed)

    def test_angles_that_were_read_back_are_those_that_the_head_was_sent_to(self):
        draw = random.Random(3)
        recorded = self.folder / self.record(1, "--seed", 3, whole=True)
        read_back = self.changed(recorded, lambda row: row | {a: f"{float(row[a]) + draw.gauss(0, 0.003):.4f}" for a in ("head_A_deg", "head_B_deg")})
        said, sent = self.diagnosis(read_back), self.diagnosis(recorded)
        self.assertEqual(said["verdict"], sent["verdict"])
        self.assertAlmostEqual(said["p_value"], sent["p_value"], delta=0.05)
        sizes = [{d["effect"]: d["detect_um"] for d in answer["smallest_detectable"]} for answer in (said, sent)]
        self.assertEqual(sizes[0].keys(), sizes[1].keys())
        for effect in sizes[0]:
            self.assertAlmostEqual(sizes[0][effect] / sizes[1][effect], 1, delta=0.15, msg=effect)

    def test_of_three_files_each_is_qualified_by_itself_unless_all_say_otherwise(self):
        first, second, third = (self.record(run, "--seed", 7) for run in (1, 2, 3))
        stated = self.changed(self.folder / third, lambda row: row | {"qualification": "1"}, "stated.csv")
        self.assertEqual(self.diagnosis(first, second, stated)["p_value"], self.diagnosis(first, second, third)["p_value"])

    def test_that_styli_count_as_qualified_anew_is_said_where_nothing_was_found(self):
        """A head that was knocked between two files passes for a new qualification: not in silence."""
        files = [self.folder / self.record(run, "--seed", 7) for run in (1, 2)]
        stated = [self.changed(f, lambda row: row | {"qualification": "1"}, f"stated_{f.name}") for f in files]
        self.assertIn("Between the files the styli count as qualified anew", self.diagnosis(*files)["otherwise"])
        for one_knows in (stated, files[:1]):
            self.assertIsNone(self.diagnosis(*one_knows)["otherwise"])

    def test_the_same_warm_up_in_each_file_is_one(self):
        """Three mornings: in one go it would be three drifts, or a swing of the room. The nights between may be logged or not."""
        warm = ("--with", "thermal.drift:amplitude_um=8,direction=x,tau_s=60")
        days = [self.record(day, *warm, "--seed", 5, "--setup", day, whole=True) for day in (1, 2, 3)]
        apart = [self.days_later(path, day) for day, path in enumerate(days)]
        for files in (days, apart):
            effect = self.diagnosis(*files)["effects"][0]
            self.assertIn("thermal.drift", effect["members"])
            self.assertIn("Its clock begins anew in each file.", effect["sentence"])
            drift = next(m["parameters"] for m in effect["by_member"] or [effect] if "amplitude_um" in m["parameters"])
            for parameter, planted in (("amplitude_um", 8), ("tau_s", 60)):
                self.assertLess(drift[parameter]["interval95"][0], planted)
                self.assertGreater(drift[parameter]["interval95"][1], planted)

    def test_a_warm_up_on_one_day_of_several_is_of_that_day(self):
        """In the whole time it was a quarter of a swing that nothing else follows: of the room's temperature control, with 0.9."""
        warm = {2: ("--with", "thermal.drift:amplitude_um=12,direction=x,tau_s=60")}
        days = [self.days_later(self.record(day, *warm.get(day, ()), "--seed", 6, "--setup", day), day) for day in (1, 2, 3)]
        effect = self.diagnosis(*days)["effects"][0]
        self.assertEqual(effect["members"][0], "thermal.drift")   # a part that soaks there does much the same
        self.assertEqual((set(effect["new_in_run"]), set(effect["gone_in_run"])), ({2}, {3}))
        self.assertIn("Its clock begins with the file of that run.", effect["sentence"])
        for parameter, planted in (("amplitude_um", 12), ("tau_s", 60)):
            self.assertLess(effect["parameters"][parameter]["interval95"][0], planted)
            self.assertGreater(effect["parameters"][parameter]["interval95"][1], planted)

    def test_what_is_there_in_all_runs_is_not_new(self):
        lobing = ("--with", "probe.pretravel_lobing:amplitude_um=3")
        said = self.diagnosis(self.record(1, *lobing), self.record(2, *lobing))
        self.assertEqual(said["effects"][0]["members"][0], "probe.pretravel_lobing")
        self.assertEqual(said["effects"][0]["new_in_run"][0], None)


if __name__ == "__main__":
    harness.main()
