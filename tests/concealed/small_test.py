#!/usr/bin/env python3
"""A small round of concealed cases, from generating to the page of evidence. usage: small_test.py PATH-OF-ABBE

Clear cases of the public development secret, whose right answer nobody doubts: effects of a signal-to-noise ratio of 15,
nulls, a stranger, a missing column, a decoy. Every step of `make evidence` but the drawing is done. Skipped (77) without numpy.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import portable  # noqa: F401
except ModuleNotFoundError:
    print("needs numpy (Debian: python3-numpy)")
    sys.exit(77)

import cases
import evidence
import follow
import generate
import plots
import run
import score
import summary
from cases import Spec

ABBE = pathlib.Path(sys.argv.pop()).resolve()
SECRET = f"development {generate.PUBLIC}"
ROUND = {
    "0001": Spec("null", detail="clean"),
    "0002": Spec("null", detail="hard"),
    "0003": Spec("single", "thermal.drift", 15.0),
    "0004": Spec("single", "probe.pretravel_lobing", 15.0),
    "0005": Spec("single", "probe.stylus_length", 15.0),
    "0006": Spec("unknown", "dent", 16.0),
    "0007": Spec("missing", "thermal.part_expansion", 10.0, "stuck"),
    "0009": Spec("pair", snr=10.0, detail="decoy"),
}


class SmallRound(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = root = pathlib.Path(cls.folder.name)
        generate.write_round("development", SECRET, ROUND.items(), root, root / "sealed", jobs=2)
        run.main([str(root), "--abbe", str(ABBE), "--jobs", "2"])
        cls.result = score.scored(root)
        cls.rows = {r["case"]: r for r in cls.result["rows"]}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def answer(self, *case):
        """What is said of a case of an opened round."""
        data, _ = cases.make(*case)
        for name, text in data.items():
            (self.root / name).write_text(text)
        words = [ABBE, "diagnose", self.root / "recording.csv", "--machine", self.root / "machine.json", "--format", "json"]
        return json.loads(subprocess.run(words, capture_output=True, check=True, text=True).stdout)

    def test_nulls_are_left_alone(self):
        for number in ("0001", "0002"):
            self.assertEqual(self.rows[number]["verdict"], "no_mismatch", number)

    def test_clear_effects_are_named(self):
        for number in ("0003", "0004", "0005"):
            r = self.rows[number]
            self.assertTrue(r["detected"] and r["right"], r)
            self.assertLess(r["p_value"], 0.01)
            self.assertGreater(r["gain"], 3)

    def test_a_stranger_is_not_named(self):
        self.assertEqual(self.rows["0006"]["verdict"], "unexplained")

    def test_a_stranger_does_not_get_the_nearest_name(self):
        """Of the fourth final round: the room's cycle comes nearest, and had been its name."""
        said = self.answer("final a440d084911db323c16f92486047d783", "0188", Spec("unknown", "busy_motor", 16.0))
        self.assertEqual((said["verdict"], said["effects"]), ("unexplained", []))

    def test_the_form_of_a_ball_is_no_geometry_beyond_the_specification(self):
        """A single of the eleventh final round: errors of 9.7 times the specification had explained it. Of one ball, those of two and a half
        times might: the form is told, and with one half."""
        said = self.answer("final fc40c50925ef603bf6659ad35586013b", "0041", Spec("single", "part.form", 15.0))
        self.assertLess(said["p_value"], 0.01)
        self.assertLess(said["baseline"]["geometry_scale"], 2.5)
        self.assertEqual([(e["members"][0], e["probability"]) for e in said["effects"]], [("part.form", 0.5)])
        self.assertGreater(said["adequacy_p_value"], 0.05)
        gain, se = (said["improvement"][k] for k in ("log_score_gain", "se"))
        self.assertTrue(0 < gain < se, (gain, se))   # which is why

    def test_without_head_angles_no_name_is_told(self):
        """A missing covariate of the sixth final round: the bending that fits what the other temperatures show had been sure."""
        said = self.answer("final d7c819ce49b85f5a19eae23142af37e1", "0041", Spec("missing", "head.sag", 10.0, "dropped"))
        self.assertEqual((said["verdict"], said["p_value"], said["effects"]), ("cannot_judge", None, []))
        self.assertIn("head_A_deg", next(e["missing"] for e in said["cannot_judge"] if e["effect"] == "head.sag"))

    def test_a_load_that_was_not_logged_is_no_clamping(self):
        """A missing covariate of the twenty-third final round: clamping in the one loaded placement had been sure."""
        said = self.answer("final f67865d93b86229cafae51a4c3d65c86", "0311", Spec("missing", "part.load_bending", 10.0, "dropped"))
        self.assertEqual(said["verdict"], "cannot_judge")
        self.assertIn("part.load_bending", said["effects"][0]["members"])
        self.assertTrue(all(e["probability"] <= 0.5 for e in said["effects"]), said["effects"])

    def test_what_was_not_logged_cannot_be_judged(self):
        self.assertIn("thermal.part_expansion", self.rows["0007"]["cannot_judge"])

    def test_a_decoy_keeps_the_truth_and_is_followed(self):
        self.assertTrue(self.rows["0009"]["right"])
        followed = follow.followed(self.root, ABBE)
        self.assertEqual([r["case"] for r in followed["rows"]], ["0009"])
        self.assertIsNotNone(followed["rows"][0]["asked"], "a wish that the generator does not understand")
        self.assertIn("resolved", follow.text(followed))
        self.assertEqual(follow.followed(self.root, ABBE), followed)

    def test_the_head_of_the_page_counts_the_cases(self):
        rows = self.result["rows"]
        nulls = [r for r in rows if r["kind"] == "null"]
        strong = [r for r in rows if r["kind"] == "single" and r["snr"] >= 6 and r["detected"]]
        strangers = [r for r in rows if r["kind"] == "unknown" and r["snr"] >= 10]
        for count in (
            f"Of {len(nulls)} simulated machines without a fault {sum(r['false_alarm'] for r in nulls)} were accused",
            f"of the {len(strong)} of this size and larger that were found {sum(r['right'] for r in strong)} were named rightly",
            f"of {len(strangers)} large ones {sum(r['detected'] for r in strangers)} were seen",
        ):
            self.assertIn(count, summary.headline(self.result).replace("\n", " "))

    def test_the_page_takes_every_block(self):
        followed = {"rows": []}
        specifications = {**plots.figures(self.result, followed), **plots.residual_maps(self.result, self.root / "answers")}
        names = plots.written(specifications, self.root / "plots")
        self.assertGreaterEqual(len(names), 14)
        self.assertIn("before_after_4", names)
        for name in names:
            spec = json.loads((self.root / f"plots/{name}.vl.json").read_text())
            self.assertTrue(spec["title"]["text"])
        blocks = evidence.blocks_of(self.result, followed, names, specifications, "round")
        page = evidence.PAGE.read_text()
        self.assertEqual(evidence.filled(evidence.filled(page, blocks), blocks), evidence.filled(page, blocks))
        with self.assertRaises(SystemExit):
            evidence.filled(page.replace("<!-- evidence targets -->", "<!-- evidence tragets -->"), blocks)

    def test_another_program_may_not_go_on(self):
        other = self.root / "other"
        other.write_text("#!/bin/sh\necho abbe 0\n")
        other.chmod(0o755)
        with self.assertRaises(SystemExit):
            run.main([str(self.root), "--abbe", str(other)])


if __name__ == "__main__":
    unittest.main()
