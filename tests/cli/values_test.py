"""Variables and questions from the command line, and messages of a machine that cannot go on where a value is missing."""
import harness

ASKING = """DMISMN/'asking',5.2
DECL/REAL,X
DECL/CHAR,20,NAME
X=PROMPT/'how far'
NAME=PROMPT/'which'
F(@NAME)=FEAT/POINT,CART,X,0,0,0,0,1
ENDFIL
"""


class Values(harness.Case):
    def test_answers_come_from_the_command_line(self):
        self.write("asking.dmi", ASKING)
        plan = self.abbe("check", "--plan", "asking.dmi", "--answer", "x=12.5", "--answer", "NAME=BORE").stdout
        self.assertIn("define BORE = POINT at 12.5 0 0", plan)

    def test_a_question_without_answer_names_the_option(self):
        self.write("asking.dmi", ASKING)
        self.assertIn("--answer X=VALUE", self.abbe("check", "asking.dmi", code=1).stderr)

    def test_answers_may_stand_in_the_program_and_the_command_line_wins(self):
        self.write("asking.dmi", ASKING.replace("ENDFIL", "$$! answer x = 12.5\n$$! answer NAME=BORE\nENDFIL"))
        self.assertIn("define BORE = POINT at 12.5 0 0", self.abbe("check", "--plan", "asking.dmi").stdout)
        self.assertIn("define BORE = POINT at 7 0 0", self.abbe("check", "--plan", "asking.dmi", "--answer", "X=7").stdout)

    def test_programs_that_ask_can_be_tests_and_be_recorded(self):
        asking = harness.LENGTH.replace("UNITS", "DECL/REAL,UPPER\nUPPER=PROMPT/'upper limit'\nUNITS", 1).replace("ENDFIL", "$$! expect TA(LEN) u >= 0\nENDFIL")
        self.write("asking.dmi", asking)
        self.abbe("test", "asking.dmi", "--machines", "20", code=1)
        self.abbe("test", "asking.dmi", "--machines", "20", "--answer", "UPPER=0.1")
        self.refused("E0604", "record", "asking.dmi", "-o", "r.csv")
        self.abbe("record", "asking.dmi", "-o", "r.csv", "--answer", "UPPER=0.1")

    def test_answers_have_a_name(self):
        self.write("asking.dmi", ASKING)
        self.assertIn("NAME=VALUE", self.refused("E0609", "check", "asking.dmi", "--answer", "12"))

    def test_an_answer_that_nobody_asks_for_is_named(self):
        self.write("asking.dmi", ASKING)
        given = ["--answer", "X=1", "--answer", "NAME=A"]
        self.assertNotIn("W0263", self.abbe("check", "asking.dmi", *given).stderr)
        said = self.abbe("check", "asking.dmi", *given, "--answer", "NAMES=B").stderr
        self.assertIn("warning W0263: the program does not ask for NAMES", said)
        self.assertIn("did you mean NAME?", said)

    def test_one_question_has_one_answer(self):
        self.write("asking.dmi", ASKING)
        self.assertIn("X has an answer already", self.refused("E0609", "check", "asking.dmi", "--answer", "X=1", "--answer", "x=2"))

    def test_a_measured_value_decides(self):
        program = harness.LENGTH.replace("OUTPUT/", "DECL/REAL,X\nX=OBTAIN/FA(B),4\nIF/(X .GT. 100)\nF(C)=FEAT/POINT,CART,50,0,0,1,0,0\n"
                                         "MEAS/POINT,F(C),1\nPTMEAS/CART,50,0,0,1,0,0\nENDMES\nENDIF\nOUTPUT/").replace(
            "ENDFIL", "T(X)=TOL/CORTOL,XAXIS,-1,1\nIF/(X .GT. 100)\nOUTPUT/FA(C),TA(X)\nENDIF\nENDFIL")
        self.write("deciding.dmi", program)
        out = self.abbe("run", "--machines", "50", "deciding.dmi").stdout
        self.assertIn("LEN", out)


harness.main()
