#include "lang/result_reader.hpp"

#include <doctest/doctest.h>

#include <string>

#include "engine/math/units.hpp"
#include "engine/report/dmis_result.hpp"
#include "lang/compile.hpp"

using namespace abbe;
using namespace abbe::lang;
using doctest::Approx;

namespace {

struct Read {
  DmisResult result;
  std::string messages;
};

Read read(const std::string& text) {
  const SourceFile source("result.dmo", text);
  Sink sink;
  Read r{read_dmis_result(source, sink), ""};
  for (const Diagnostic& d : sink.sorted()) r.messages += std::string(info(d.code).name) + " ";
  return r;
}

/// Every kind of feature once.
constexpr const char* kProgram = R"(DMISMN/'all kinds'
F(PT)=FEAT/POINT,CART,1,2,3,0,0,1
F(LN)=FEAT/LINE,BND,CART,0,0,1,80,0,1,0,0,1
F(PL)=FEAT/PLANE,CART,0,0,5,0,0.6,0.8
F(CI)=FEAT/CIRCLE,INNER,CART,50,50,0,0,0,1,20
F(CY)=FEAT/CYLNDR,OUTER,CART,50,50,0,0,0,1,20,30
F(SP)=FEAT/SPHERE,OUTER,CART,100,100,50,25
F(CO)=FEAT/CONE,INNER,CART,0,0,-40,0,0,1,60
F(TO)=FEAT/TORUS,OUTER,CART,0,0,0,0,0,1,80,20
F(AR)=FEAT/ARC,INNER,CART,50,50,0,0,0,1,20,30,90
F(EL)=FEAT/ELLIPS,INNER,CART,-30,0,0,30,0,0,MAJOR,100,0,0,1
F(SL)=FEAT/CPARLN,INNER,ROUND,CART,40,30,-5,0,0,1,1,0,0,30,10
F(KE)=FEAT/CPARLN,OUTER,FLAT,CART,40,30,-5,0,0,1,0,1,0,30,10
F(RE)=FEAT/RCTNGL,OUTER,CART,0,0,0,1,0,0,60,0,1,0,40,0,0,1,20
F(PP)=FEAT/PARPLN,INNER,MIDPL,CART,40,30,-5,0,1,0,10
F(SY)=FEAT/SYMPLN,OUTER,CART,0,0,0,1,0,0,80
F(ED)=FEAT/EDGEPT,CART,100,20,0,1,0,0,0,0,1
F(GS)=FEAT/GSURF
ENDFIL
)";

void check_near(const Vec3& a, const Vec3& b) { CHECK(norm(a - b) < 2e-5); }

}  // namespace

TEST_CASE("what is written of every kind of feature is read again") {
  const SourceFile source("all.dmi", kProgram);
  Sink sink;
  plan::Plan plan = compile(source, sink).plan;
  REQUIRE_FALSE(sink.has_errors());
  plan::Output output;
  OutputRecord record{static_cast<int>(plan.operations.size()), {}, {}, {}};
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    output.features.push_back({static_cast<int>(i)});
    record.features.push_back(plan.features[i].nominal);
  }
  plan.operations.push_back({output, {}, 0});
  const Read back = read(dmis_result(plan, {record}));
  CHECK(back.messages == "");
  REQUIRE(back.result.features.size() == plan.features.size());
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    const ResultFeature& f = back.result.features[i];
    const Element &was = plan.features[i].nominal, &is = f.actual;
    CAPTURE(f.label);
    CHECK(f.label == plan.features[i].label);
    CHECK(f.kind == plan.features[i].kind);
    CHECK(f.inner == plan.features[i].inner);
    check_near(is.point, was.point);
    check_near(is.direction, was.direction);
    check_near(is.second, was.second);
    CHECK(is.size == Approx(was.size).epsilon(1e-6));
    CHECK(is.minor_size == Approx(was.minor_size).epsilon(1e-6));
    CHECK(is.angle == Approx(was.angle).epsilon(1e-6));
    CHECK(is.end - is.begin == Approx(was.end - was.begin).epsilon(1e-6));
  }
}

TEST_CASE("coordinate systems, values and uncertainties are read again") {
  const SourceFile source("frames.dmi",
                          "DMISMN/'f'\nD(P)=DATSET/TRMATX,0,1,0,-1,0,0,0,0,1,10,20,30\nOUTPUT/DA(P)\nENDFIL\n");
  Sink sink;
  const plan::Plan plan = compile(source, sink).plan;
  const Rigid X{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, {10, 20, 30}};
  const OutputRecord record{static_cast<int>(plan.operations.size()) - 1, {}, {}, X};
  const std::string text = dmis_result(plan, {record});
  CHECK(text.find("DA(P) = DATSET/TRMATX, 0.000000000, 1.000000000, 0.000000000, -1.000000000") != std::string::npos);
  const DmisResult back = read(text).result;
  REQUIRE(back.frames.size() == 1);
  CHECK(back.frames[0].label == "P");
  check_near(back.frames[0].X_MD.p, X.p);
  check_near(back.frames[0].X_MD.R * Vec3{1, 2, 3}, X.R * Vec3{1, 2, 3});
}

TEST_CASE("a turned coordinate system comes back to a nanometre over a metre") {
  const SourceFile source("turned.dmi", "DMISMN/'t'\nD(P)=ROTATE/ZAXIS,0.5\nOUTPUT/DA(P)\nENDFIL\n");
  Sink sink;
  const plan::Plan plan = compile(source, sink).plan;
  const double c = std::cos(0.5), s = std::sin(0.5);
  const Rigid X{{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}, {10, 20, 30}};
  const DmisResult back =
      read(dmis_result(plan, {OutputRecord{static_cast<int>(plan.operations.size()) - 1, {}, {}, X}})).result;
  REQUIRE(back.frames.size() == 1);
  CHECK(norm(back.frames[0].X_MD.R * Vec3{600, 800, 0} - X.R * Vec3{600, 800, 0}) < 1e-6);
}

TEST_CASE("every form of a result and its uncertainty comes back as it was written") {
  const SourceFile source(
      "results.dmi",
      "DMISMN/'r'\nSNSLCT/SA(P)\nF(C)=FEAT/CIRCLE,INNER,CART,5,0,0,0,0,1,20\nMEAS/CIRCLE,F(C),4\nENDMES\n"
      "F(E)=FEAT/CIRCLE,INNER,CART,50,0,0,0,0,1,20\nMEAS/CIRCLE,F(E),4\nENDMES\nT(SIZE)=TOL/DIAM,-0.1,0.1\nT(PLACE)=TOL/POS,2D,0.1\n"
      "T(ANGLE)=TOL/CORTOL,ANGLE,-1,1\nT(APART)=TOL/DISTB,NOMINL,45,-0.1,0.1,XAXIS\nOUTPUT/FA(C),TA(SIZE),TA(PLACE),TA(ANGLE)\n"
      "OUTPUT/FA(C),FA(E),TA(APART)\nOUTPUT/FA(C),TA(SIZE)\nENDFIL\n");
  Sink sink;
  const plan::Plan plan = compile(source, sink).plan;
  REQUIRE_FALSE(sink.has_errors());
  std::vector<OutputRecord> records;
  std::vector<CharacteristicReport> reports;
  std::vector<double> written;
  for (std::size_t i = 0; i < plan.operations.size(); ++i) {
    const auto* output = std::get_if<plan::Output>(&plan.operations[i].action);
    if (!output) continue;
    OutputRecord record{static_cast<int>(i), {}, {}, {}};
    for (const plan::FeatureId f : output->features) record.features.push_back(plan[f].nominal);
    for (const plan::CharacteristicId c : output->characteristics) {
      const double value = 0.01 * static_cast<double>(written.size() + 1);
      const bool inside = written.size() % 2 == 0;
      record.values.push_back({c, value, {std::nullopt, inside ? value : 0.0}});  // a limit is inside
      CharacteristicReport report;
      report.characteristic = c, report.reference = value;
      report.tolerance = plan[plan[c].tolerance].label, report.line = plan[c].line;
      report.summary.u = value / 100, report.lcl = -value / 50, report.ucl = value / 40;
      if (inside) report.conformance_probability = 0.75;
      reports.push_back(report);
      written.push_back(value);
    }
    records.push_back(std::move(record));
  }
  const Read back = read(dmis_result(plan, records, reports));
  CHECK(back.messages == "");
  REQUIRE(back.result.values.size() == 5);
  REQUIRE(written.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    const ResultValue& v = back.result.values[i];
    CAPTURE(v.label);
    CHECK(v.label == reports[i].tolerance);
    CHECK(v.value == Approx(written[i]).epsilon(1e-4));
    CHECK(v.in_tolerance == (i % 2 == 0));
    REQUIRE(v.uncertainty.has_value());
    CHECK(v.uncertainty->u == Approx(written[i] / 100).scale(0));
    CHECK(v.uncertainty->lcl == Approx(-written[i] / 50).scale(0));
    CHECK(v.uncertainty->ucl == Approx(written[i] / 40).scale(0));
    CHECK(v.uncertainty->conformance.has_value() == (i % 2 == 0));
  }
  // The next turn of a loop has an uncertainty of its own; what is the same on every machine has none.
  records = {records.front(), records.front()};
  reports.push_back(reports.front());
  reports.back().evaluation = 2, reports.back().summary.u = 0.5;
  reports[1].varies = false;
  const auto turns = read(dmis_result(plan, records, reports)).result.values;
  REQUIRE(turns.size() == 6);
  CHECK(turns[0].uncertainty->u == Approx(written[0] / 100).scale(0));
  CHECK(turns[3].uncertainty->u == 0.5);
  CHECK_FALSE(turns[1].uncertainty);
  records.front().features.front().point.x = -1e-9;
  CHECK(dmis_result(plan, records).find("-0.00000") == std::string::npos);
}

TEST_CASE("results of tolerances in all their forms") {
  const Read r = read(
      "UNITS/INCH,ANGDEC\nTA(D)=TOL/DIAM,2,INTOL\n$$! u TA(D) 0.0005 lcl -0.001 ucl 0.0011 conforms 0.98\n"
      "TA(P) = TOL/POS, 3D, 0.5, OUTOL\n$$! u TA(OTHER) 9 lcl 9 ucl 9\nTA(L)=TOL/DISTB,INTOL,NOMINL,10,XAXIS\n"
      "TA(A)=TOL/CORTOL,ANGLE,90,INTOL\n");
  CHECK(r.messages == "");
  REQUIRE(r.result.values.size() == 4);
  const auto& v = r.result.values;
  CHECK(v[0].value == Approx(50.8));
  CHECK(v[0].in_tolerance);
  REQUIRE(v[0].uncertainty.has_value());
  CHECK(v[0].uncertainty->ucl == 0.0011);
  CHECK(v[0].uncertainty->conformance == 0.98);
  CHECK(v[1].qualifier == "3D");
  CHECK_FALSE(v[1].in_tolerance);
  CHECK_FALSE(v[1].uncertainty.has_value());
  CHECK(v[2].value == Approx(254));
  CHECK(v[2].qualifier == "XAXIS");
  CHECK(v[3].value == Approx(kPi / 2));
}

TEST_CASE("what cannot be read is said, and the rest is read") {
  const Read r = read(
      "TA(A)=TOL/DIAM,INTOL\nFA(B)=FEAT/CIRCLE,INNER,CART,1,2\nFA(C)=FEAT/BLOB,1\nTA(D)=TOL/BLOB,1,INTOL\n"
      "FA(E)=FEAT/PLANE,CART,0,0,0,0,0,0\nDA(F)=DATSET/TRMATX,1,0\nFA(G)=FEAT/POINT,CART,1,2,3,0,0,1\n");
  CHECK(r.messages == "E0507 E0107 E0112 E0112 E0208 E0107 ");
  REQUIRE(r.result.features.size() == 1);
  CHECK(r.result.features[0].line == 7);
}

TEST_CASE("the last digit of a value counts in the unit that the file has") {
  const auto values = read(
                          "UNITS/INCH,ANGRAD\nTA(A)=TOL/DIAM,1.250,INTOL\nTA(B)=TOL/ANGLB,1.57,INTOL\nUNITS/MM,ANGDEC\n"
                          "TA(C)=TOL/DIAM,$\n31.75,INTOL\nTA(D)=TOL/ANGLB,90.0,INTOL\n")
                          .result.values;
  REQUIRE(values.size() == 4);
  CHECK(values[0].last_digit == Approx(0.0254));
  CHECK(values[1].last_digit == Approx(0.01));
  CHECK(values[2].last_digit == Approx(0.01));
  CHECK(values[3].last_digit == Approx(0.1 * kDegree));
}
