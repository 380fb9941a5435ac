"""abbe diagnose on recordings damaged by chance: every one is judged or refused, whatever stands in it."""
import json
import random

import harness

PROGRAM = harness.ROOT / "examples/iso10360/form_and_size_1x25.dmi"
MACHINE = harness.ROOT / "examples/iso10360/portal-2009.json"
ODD = ("", "0", "-1", "1e308", "1e-308", "nan", "inf", "1e9", "abc", "99999999999", "-0", "1e-7", "180", '"q', "é", "1;2")


def damage(text, rng):
    """One to three faults: a field, a column, a row or a line before the table."""
    remarks = [line for line in text.splitlines() if line.startswith("#")]
    rows = [line.split(",") for line in text.splitlines() if not line.startswith("#")][:14]

    def column(change):
        at = rng.randrange(len(rows[0]))
        for row in rows[1:]:
            row[at] = change(row[at])

    def scaled(by):
        return lambda field: repr(by * float(field)) if field.replace(".", "").replace("-", "").isdigit() else field

    def fault(kind):
        odd, row = rng.choice(ODD), rng.randrange(1, len(rows))
        if kind == "field":
            rows[row][rng.randrange(len(rows[row]))] = odd
        elif kind == "column":
            column(lambda field: odd)
        elif kind == "scale":
            column(scaled(rng.choice((0, 1e-3, -1, 1e3, 1e6))))
        elif kind == "no column":
            at = rng.randrange(len(rows[0]))
            for r in rows:
                del r[at]
        elif kind == "no row":
            del rows[row]
        elif kind == "twice":
            rows.append(list(rows[row]))
        elif kind == "remark":
            del remarks[rng.randrange(len(remarks))]
        else:
            at = rng.randrange(len(remarks))
            place = rng.randrange(len(remarks[at]))
            remarks[at] = remarks[at][:place] + rng.choice("019.-: z") + remarks[at][place + 1:]

    for _ in range(rng.choice((1, 1, 2, 3))):
        fault(rng.choice(("field", "field", "column", "scale", "no column", "no row", "twice", "remark", "letter")))
    return "\n".join(remarks + [",".join(row) for row in rows]) + "\n"


class DamagedRecordings(harness.Case):
    def test_every_one_is_judged_or_refused(self):
        self.abbe("record", PROGRAM, "--machine", MACHINE, "--with", "probe.pretravel_lobing:amplitude_um=3", "-o", "whole.csv")
        whole, rng, judged = (self.folder / "whole.csv").read_text(), random.Random(20261123), 0
        for number in range(120):
            text = damage(whole, rng)
            options = rng.choice(((), ("--design-only",), ("--program", PROGRAM)))
            done = self.abbe("diagnose", self.write("damaged.csv", text), "--machine", MACHINE, "--format", "json", *options, code=(0, 2))
            with self.subTest(number=number, options=options, said=done.stderr, text=text):
                if done.returncode == 0:
                    judged += 1
                    json.loads(done.stdout, parse_constant=self.fail)
                else:
                    self.assertIn("error E", done.stderr)
                    self.assertEqual(done.stdout, "")
        self.assertGreater(judged, 10)   # most damage is refused before anything is judged


if __name__ == "__main__":
    harness.main()
