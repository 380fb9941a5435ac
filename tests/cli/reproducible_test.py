"""The same answers to the bit, whatever instructions the processor has: a C library chooses its functions by them."""
import os
import subprocess

import harness

MACHINE = harness.ROOT / "examples/machines/coord3-mc16.json"
PROGRAM = harness.ROOT / "examples/iso10360/form_and_size_1x25.dmi"
OLD_PROCESSOR = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F,-AVX2,-AVX,-FMA,-FMA4,-BMI2,-SSE4_1"}
# Exact by their definition, or in numbers of 80 bits, which have one set of instructions.
ONE_RESULT = {"ceil", "copysign", "fabs", "floor", "fmax", "fmin", "fmod", "frexp", "ldexp", "llrint", "llround", "lrint", "lround", "nearbyint", "remainder",
              "rint", "round", "scalbn", "sqrt", "trunc", "cosl", "hypotl", "sincosl", "sinl"}


class Reproducible(harness.Case):
    def test_an_old_processor_gives_the_same_bits(self):
        self.abbe("record", PROGRAM, "--machine", MACHINE, "--seed", 24, "--with", "probe.pretravel_lobing:amplitude_um=3", "-o", "sphere.csv")
        for command in (("run", PROGRAM, "--machines", 200, "--budget"), ("diagnose", "sphere.csv"), ("diagnose", "sphere.csv", "--design-only")):
            answers = [subprocess.run([self.abbe_path, *map(str, command), "--machine", MACHINE, "--format", "json"], cwd=self.folder,
                                      env=os.environ | instructions, capture_output=True, check=True).stdout for instructions in ({}, OLD_PROCESSOR)]
            self.assertEqual(*answers, command)

    def test_no_function_of_the_c_library_that_may_choose_is_used(self):
        """The test above sees a difference only where a processor has the instructions and an answer turns on the last bit."""
        def names(*options):
            listed = subprocess.run(["nm", "-D", *options], capture_output=True, text=True, check=True).stdout
            return {line.split()[-1].split("@")[0] for line in listed.splitlines()}
        used = next(line.split()[2] for line in subprocess.run(["ldd", self.abbe_path], capture_output=True, text=True, check=True).stdout.splitlines()
                    if line.split()[0].startswith("libm.so"))
        self.assertLessEqual(names("--undefined-only", self.abbe_path) & names("--defined-only", used), ONE_RESULT)


if __name__ == "__main__":
    harness.main()
