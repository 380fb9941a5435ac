// OBTAIN of everything that can be read, and the uncertainty of alignments through the language.
#include <cmath>

#include "tests/unit/whole/programs.hpp"

using namespace abbe;
using namespace abbe::test;
using doctest::Approx;

namespace {

/// The values that expressions have on the error-free machine: every one becomes the x of a point.
std::vector<double> values(const std::string& statements, const std::vector<std::string>& expressions) {
  std::string text = statements;
  for (std::size_t i = 0; i < expressions.size(); ++i)
    text += fmt::format(
        "VALUE{0}={1}\nF(V{0})=FEAT/POINT,CART,VALUE{0},0,0,0,0,1\nMEAS/POINT,F(V{0}),1\nPTMEAS/CART,VALUE{0},0,0,0,0,1\nENDMES\nOUTPUT/FA(V{0})\n",
        i, expressions[i]);
  const Ran ran(text);
  std::vector<double> out;
  for (std::size_t i = 0; i < expressions.size(); ++i) out.push_back(ran.output(fmt::format("V{}", i)).point.x);
  return out;
}

/// How many arguments the statement has, its word included.
int arguments_of(std::string_view example) {
  return 1 + static_cast<int>(std::count(example.begin(), example.end(), ',')) + 1;
}

bool is_word(std::string_view example, int argument) {
  std::size_t begin = example.find('/') + 1;
  for (int k = 2; k < argument; ++k) begin = example.find(',', begin) + 1;
  return std::isalpha(static_cast<unsigned char>(example[begin])) != 0;
}

}  // namespace

TEST_CASE("what is measured of a feature without errors is what defines it, argument by argument") {
  // The examples, and what they do not try: other forms of the same kinds.
  std::vector<std::string> forms = {
      "F(X)=FEAT/LINE,UNBND,CART,1,2,3,1,0,0,0,0,1", "F(X)=FEAT/ELLIPS,INNER,CART,-30,0,0,30,0,0,MINOR,80,0,0,1",
      "F(X)=FEAT/PARPLN,INNER,CART,0,25,0,0,1,0,0,35,0,0,-1,0", "F(X)=FEAT/CIRCLE,OUTER,POL,50,30,4,0,0,1,20",
      "F(X)=FEAT/RCTNGL,OUTER,CART,0,0,0,1,0,0,60,0,-1,0,40,0,0,1,20"};
  for (const FeatureKind* kind : feature_kinds())
    if (kind->pattern.touch) forms.emplace_back(kind->example);
  int numbers = 0;
  for (const std::string& form : forms) {
    CAPTURE(form);
    const std::string label = form.substr(2, form.find(')') - 2),
                      kind = form.substr(form.find('/') + 1, form.find(',') - form.find('/') - 1);
    std::vector<std::string> measured_and_defined;
    for (int k = 3; k <= arguments_of(form); ++k) {
      if (is_word(form, k)) continue;
      measured_and_defined.push_back(fmt::format("OBTAIN/FA({}),{}", label, k));
      measured_and_defined.push_back(fmt::format("OBTAIN/F({}),{}", label, k));
    }
    const std::vector<double> v =
        values(form + fmt::format("\nMEAS/{},F({}),12\nENDMES\n", kind, label), measured_and_defined);
    // Where along itself a line or an axis has its point, and how long it is, depends on the touches.
    for (std::size_t i = 0; i < v.size(); i += 2) {
      CAPTURE(measured_and_defined[i]);
      const bool along = kind == "CYLNDR" || (kind == "LINE" && form.find("UNBND") != std::string::npos);
      if (!along) CHECK(v[i] == Approx(v[i + 1]).epsilon(1e-6));
      ++numbers;
    }
  }
  CHECK(numbers > 100);
}

TEST_CASE("a cylinder is read as the result file has it: from where its touches begin") {
  std::string turned = "F(C)=FEAT/CYLNDR,INNER,CART,10,20,0,0,0,1,20\nMEAS/CYLNDR,F(C),8\n";
  for (const char* z : {"-2", "-18"})  // leaning, so that each height has another centre
    turned += fmt::format(
        "PTMEAS/CART,{0},20,{1},-1,0,0\nPTMEAS/CART,{2},20,{1},1,0,0\nPTMEAS/CART,{3},30,{1},0,-1,0\nPTMEAS/CART,{3},10,{1},0,1,0\n",
        z[1] == '2' ? 20.0 : 20.1, z, z[1] == '2' ? 0.0 : 0.1, z[1] == '2' ? 10.0 : 10.1);
  turned += "ENDMES\nOUTPUT/FA(C)\n";
  for (const bool polar : {false, true}) {
    CAPTURE(polar);
    std::string program = turned;
    if (polar) program.replace(program.find("CART,10,20,0"), 12, "POL,22.36067977,63.43494882,0");
    const std::vector<double> v =
        values(program, {"OBTAIN/FA(C),5", "OBTAIN/FA(C),6", "OBTAIN/FA(C),7", "OBTAIN/FA(C),11"});
    const FeatArguments form = find_feature_kind("CYLNDR")->written(Ran(program).output("C"));
    const Vec3 place = std::get<Vec3>(form[1]);
    CHECK(place.z == Approx(-18).epsilon(0.01));
    CHECK(v[0] == Approx(polar ? std::hypot(place.x, place.y) : place.x));
    CHECK(v[1] == Approx(polar ? std::atan2(place.y, place.x) * 180 / kPi : place.y));
    CHECK(v[2] == Approx(place.z));
    CHECK(v[3] == Approx(std::get<double>(form[3])));
  }
}

TEST_CASE("numbers come in the units of the program") {
  const std::vector<double> v =
      values("UNITS/INCH,ANGDEC\nF(C)=FEAT/CIRCLE,INNER,CART,1,1,0,0,0,1,2\nMEAS/CIRCLE,F(C),4\nENDMES\n",
             {"OBTAIN/FA(C),5", "OBTAIN/FA(C),11"});
  CHECK(v[0] == Approx(25.4));  // the values are put out in mm
  CHECK(v[1] == Approx(50.8));
}

TEST_CASE("the value of a tolerance comes in the units of the program too") {
  CHECK(
      values(
          "UNITS/INCH,ANGDEC\nT(D)=TOL/DIAM,-1,1\nF(C)=FEAT/CIRCLE,INNER,CART,1,1,0,0,0,1,2\nMEAS/CIRCLE,F(C),4\nENDMES\n"
          "EVAL/FA(C),T(D)\n",
          {"OBTAIN/TA(D),3"})[0] == Approx(50.8));  // two inches, put out in mm
  // A countersink of 90 degrees: its radius grows as its depth. Of the cone and of its tolerance the angle is the whole one.
  const std::string cone = "T(A)=TOL/ANGL,-1,1\n" +
      measured("C", "CONE,INNER,CART,0,0,0,0,0,1,90",
               {"2,0,2,-1,0,1", "-2,0,2,1,0,1", "0,2,2,0,-1,1", "0,-2,2,0,1,1", "9,0,9,-1,0,1", "-9,0,9,1,0,1",
                "0,9,9,0,-1,1", "0,-9,9,0,1,1"}) +
      "EVAL/FA(C),T(A)\n";
  const std::vector<double> angles = values(cone, {"OBTAIN/FA(C),11", "OBTAIN/TA(A),3"});
  CHECK(angles[0] == Approx(90));
  CHECK(angles[1] == Approx(90));
}

TEST_CASE("variables hold what was measured, whatever they are made of") {
  const std::string two = "DECL/REAL,X,Y,ZERO,A[2]\nDECL/VECTOR,V\n" +
      measured("P", "POINT,CART,5,20,0,0,0,1", {"5,20,0,0,0,1"}) +
      "X=OBTAIN/FA(P),4\nY=OBTAIN/FA(P),5\nZERO=OBTAIN/FA(P),6\n";
  // Both components are read before either is changed.
  CHECK(values(two + "V=ASSIGN/VCART(X,Y,0)\nV=ASSIGN/VCART(VECY(V),VECX(V),0)\n",
               {"ASSIGN/VECX(V)", "ASSIGN/VECY(V)"}) == std::vector<double>{20, 5});
  // A measured index changes one element, and nobody knows before which.
  CHECK(values(two + "A[1]=ASSIGN/7\nA[2]=ASSIGN/8\nA[NINT(1+ZERO)]=ASSIGN/9\n", {"ASSIGN/A[1]", "ASSIGN/A[2]"}) ==
        std::vector<double>{9, 8});
}

TEST_CASE("tolerances and sensors can be read") {
  const std::string defined =
      "T(D)=TOL/DIAM,-0.2,0.1\nF(C)=FEAT/CIRCLE,INNER,CART,20,20,0,0,0,1,10\nMEAS/CIRCLE,F(C),4\n"
      "PTMEAS/CART,25.1,20,0,-1,0,0\nPTMEAS/CART,20,25.1,0,0,-1,0\nPTMEAS/CART,14.9,20,0,1,0,0\nPTMEAS/CART,20,14.9,0,0,1,0\nENDMES\nEVAL/FA(C),T(D)\n";
  const std::vector<double> v = values(defined, {"OBTAIN/T(D),3", "OBTAIN/T(D),4", "OBTAIN/TA(D),3", "OBTAIN/S(P),10"});
  CHECK(v[0] == Approx(-0.2));
  CHECK(v[1] == Approx(0.1));
  CHECK(v[2] == Approx(10.2));
  CHECK(v[3] == Approx(150));
  // Diameter 10.2 is outside 10 -0.2 +0.1, and texts can be compared.
  const std::vector<double> texts =
      values(defined +
                 "DECL/CHAR,9,A,B,C\nDECL/REAL,X\nX=ASSIGN/0\nA=OBTAIN/TA(D),4\nB=OBTAIN/S(P),3\nC=OBTAIN/T(D),1\n"
                 "IF/(A .EQ. 'OUTOL' .AND. B .EQ. 'INDEX' .AND. C .EQ. 'TOL')\nX=ASSIGN/1\nENDIF\n",
             {"ASSIGN/X"});
  CHECK(texts[0] == 1);
}

TEST_CASE("a bonus counts from the nominal that each machine took from a measured one") {
  const std::string bore = "CIRCLE,INNER,CART,20,20,0,0,0,1,";
  const Ran ran("F(A)=FEAT/" + bore + "10\nMEAS/CIRCLE,F(A),6\nENDMES\nT(FIRST)=TOL/DIAM,-1,1\nEVAL/FA(A),T(FIRST)\n" +
                    "X=OBTAIN/FA(A),11\nF(B)=FEAT/" + bore + "X\nMEAS/CIRCLE,F(B),6\nENDMES\n" +
                    "T(SIZE)=TOL/DIAM,-0.1,0.2\nT(PLACE)=TOL/POS,2D,0.05,MMC\nEVAL/FA(B),T(SIZE),T(PLACE)\n",
                20);
  const Samples& place = ran.samples("PLACE");
  REQUIRE(place.own_limits.size() == 20);
  for (std::size_t i = 0; i < 20; ++i) {
    const double smallest = ran.samples("FIRST").value[i] - 0.1;
    CHECK(*place.own_limits[i].upper == Approx(0.05 + ran.samples("SIZE").value[i] - smallest).epsilon(1e-9));
  }
}

TEST_CASE("limits that each machine computed from what it measured judge its own value") {
  const std::string bore = "CIRCLE,INNER,CART,20,20,0,0,0,1,10\nMEAS/CIRCLE,F(";
  const Ran ran("F(A)=FEAT/" + bore + "A),6\nENDMES\nT(FIRST)=TOL/DIAM,-1,1\nEVAL/FA(A),T(FIRST)\nX=OBTAIN/FA(A),11\n" +
                    "T(OWN)=TOL/DIAM,X-10-0.001,X-10+0.002\nF(B)=FEAT/" + bore + "B),6\nENDMES\nEVAL/FA(B),T(OWN)\n",
                20);
  const Samples& own = ran.samples("OWN");
  REQUIRE(own.own_limits.size() == 20);
  CHECK(ran.samples("FIRST").own_limits.empty());
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(*own.own_limits[i].lower == Approx(ran.samples("FIRST").value[i] - 0.001).epsilon(1e-12));
    CHECK(*own.own_limits[i].upper == Approx(ran.samples("FIRST").value[i] + 0.002).epsilon(1e-12));
  }
}

TEST_CASE("a DO whose limit is measured has the turns of one that is known") {
  const std::string loop = "DECL/INTGR,N,LAST\nDECL/REAL,X,ZERO\nDECL/INTGR,I\n" +
      measured("A", "POINT,CART,0,0,0,0,0,1", {"0,0,0,0,0,1"}) + "ZERO=OBTAIN/FA(A),6\n";
  // The last turn is where the sum of three steps is not the limit; whole numbers are cut off turn by turn.
  const std::vector<double> turns =
      values(loop + "N=ASSIGN/0\nDO/X,0,0.3+ZERO,0.1\nN=ASSIGN/N+1\nENDDO\n", {"ASSIGN/N", "ASSIGN/X"});
  CHECK(turns[0] == 4);
  CHECK(turns[1] == Approx(0.4));
  const std::vector<double> halves =
      values(loop + "N=ASSIGN/0\nLAST=ASSIGN/0\nDO/I,0,2+ZERO,0.5\nN=ASSIGN/N+1\nLAST=ASSIGN/10*LAST+I\nENDDO\n",
             {"ASSIGN/N", "ASSIGN/LAST"});
  CHECK(halves == std::vector<double>{5, 112});
  // Nor is a beginning that is measured cut off where nobody declared the variable.
  const std::vector<double> begun =
      values(loop + "N=ASSIGN/0\nDO/K,0.5+ZERO,2\nN=ASSIGN/N+1\nENDDO\n", {"ASSIGN/N", "ASSIGN/K"});
  CHECK(begun[0] == 2);
  CHECK(begun[1] == Approx(2.5));
  // A body that sets the variable is left early.
  for (const char* limit : {"9+ZERO", "9"})
    CHECK(values(loop + "N=ASSIGN/0\nDO/I,1," + limit + "\nN=ASSIGN/N+1\nI=ASSIGN/I+3\nENDDO\n", {"ASSIGN/N"}) ==
          std::vector<double>{3});
  // What a macro sets is set in every turn.
  CHECK(values(loop + "M(INC)=MACRO\nN=ASSIGN/N+1\nENDMAC\nN=ASSIGN/0\nDO/I,1,3+ZERO\nCALL/M(INC)\nENDDO\n",
               {"ASSIGN/N"}) == std::vector<double>{3});
}
