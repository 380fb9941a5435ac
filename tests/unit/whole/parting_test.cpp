// Programs in the language whose path depends on measured values: each machine must get exactly what it gets
// alone, whatever block it runs in. The programs are random; their thresholds are of the size of the
// machine's errors, so machines do part.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "engine/lanes/random.hpp"
#include "engine/run/run.hpp"
#include "lang/compile.hpp"

using namespace abbe;

namespace {

/// Writes a random program, statement by statement.
class Author {
 public:
  explicit Author(std::uint32_t number) : number_(number) {}

  std::string program() {
    text_ =
        "DMISMN/'random',5.2\nDECL/REAL,X,Y,A[4]\nDECL/INTGR,I,J,N\nDECL/CHAR,9,L\nDECL/BOOL,B\n"
        "S(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,150,4\nS(Q)=SNSDEF/PROBE,INDEX,POL,45,90,0,0,-1,150,4\nSNSLCT/S(P)\n"
        "M(POINT)=MACRO/'NAME',XX,ZZ\nF('NAME')=FEAT/POINT,CART,XX,300,ZZ,0,-1,0\nMEAS/POINT,F('NAME'),1\nPTMEAS/CART,XX,300,ZZ,0,-1,0\nENDMES\n"
        "Y=OBTAIN/FA('NAME'),5\nENDMAC\nT(T)=TOL/CORTOL,YAXIS,-0.002,0.002\nN=ASSIGN/0\nX=ASSIGN/0\n";
    for (int step = 0; step < 5; ++step) {
      measure(fmt::format("'A{}'", step));
      part(step);
      text_ += fmt::format("OUTPUT/FA(A{}),TA(T)\n", step);
    }
    return text_ + "ENDFIL\n";
  }

 private:
  double uniform() { return uniform_pair({number_, 0, stream_of("random text"), 0, 0, next_++}).a; }
  int below(int n) { return static_cast<int>(uniform() * n); }
  std::string threshold() { return fmt::format("{:.5f}", 300 + 0.004 * (uniform() - 0.5)); }
  void measure(const std::string& label) {
    text_ += fmt::format("CALL/M(POINT),{},{:.1f},{:.1f}\n", label, 600 + 300 * uniform(), -600 + 200 * uniform());
  }

  /// Something that machines may do differently after Y was measured.
  void part(int step) {
    switch (below(6)) {
      case 0:
        text_ += fmt::format("X=ASSIGN/0\nIF/(Y .GT. {})\nSNSLCT/S(Q)\nX=ASSIGN/X+1\n", threshold());
        measure(fmt::format("'B{}'", step));
        text_ += fmt::format("ELSE\nIF/(Y .LT. {} .OR. X .GT. 2)\n", threshold());
        measure(fmt::format("'B{}'", step));
        text_ +=
            fmt::format("ENDIF\nX=ASSIGN/7\nENDIF\nIF/(X .GE. 1 .AND. X .LT. 7)\nEVAL/FA(B{}),TA(T)\nENDIF\n", step);
        break;
      case 1:
        text_ += fmt::format("(AGAIN{})\nN=ASSIGN/N+1\n", step);
        measure(fmt::format("'C{}'", step));
        text_ += fmt::format("IF/(Y .GT. {} .AND. N .LT. 8)\nJUMPTO/(AGAIN{})\nENDIF\nEVAL/FA(C{}),TA(T)\n",
                             threshold(), step, step);
        break;
      case 2:
        text_ += fmt::format(
            "J=ASSIGN/NINT((Y-300)*1000)\nSELECT/ABS(J)\nCASE/0\nL=ASSIGN/'ZERO'\nENDCAS\nCASE/1,2\nL=ASSIGN/'SOME'\n");
        measure(fmt::format("'D{}'", step));
        text_ +=
            "ENDCAS\nDFTCAS\nL=ASSIGN/'MANY'\nD(D)=TRANS/YORIG,Y-300\nENDCAS\nENDSEL\nIF/(L .EQ. 'SOME')\nSNSLCT/S(P)\nX=ASSIGN/X*2\nENDIF\n";
        break;
      case 3:
        text_ += fmt::format("DO/I,1,MN(4,1+ABS(NINT((Y-300)*800)))\n");
        measure(fmt::format("'E{}'", step));
        text_ +=
            fmt::format("A[I]=ASSIGN/Y\nIF/(Y .GT. {})\nJUMPTO/(OUT{})\nENDIF\nENDDO\n(OUT{})\nEVAL/FA(E{}),TA(T)\n",
                        threshold(), step, step, step);
        break;
      case 4:
        text_ += fmt::format(
            "F(G{0})=FEAT/LINE,UNBND,CART,700,300,-500,1,0,0,0,-1,0\nMEAS/LINE,F(G{0}),2\nPTMEAS/CART,700,300,-500,0,-1,0\nPTMEAS/CART,800,300,-500,0,-1,0\n"
            "IF/(Y .LT. {1})\nPTMEAS/CART,900,300,-500,0,-1,0\nENDIF\nENDMES\nT(S{0})=TOL/STRGHT,0.01\nEVAL/FA(G{0}),TA(S{0})\n",
            step, threshold());
        break;
      default:
        text_ += fmt::format(
            "B=ASSIGN/Y .GT. {}\nDO/I,1,3\nIF/(B)\nJUMPTO/(NEXT{})\nENDIF\nX=ASSIGN/X+I\n(NEXT{})\nENDDO\nGOTO/X,200,-300\n",
            threshold(), step, step);
    }
  }

  std::uint32_t number_, next_ = 0;
  std::string text_;
};

RunResult run(const plan::Plan& plan, const Machine& machine, const VirtualMachines& machines, int block_lanes,
              const SourceFile& source) {
  RunOptions options;
  options.block_lanes = block_lanes;
  options.threads = 2;
  return run_plan(plan, machine, machines, options, source);
}

void check_same(const RunResult& a, const RunResult& b) {
  REQUIRE(a.samples.size() == b.samples.size());
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    CHECK(a.samples[i].value == b.samples[i].value);
    CHECK(a.samples[i].machine == b.samples[i].machine);
    CHECK(a.samples[i].reference == b.samples[i].reference);
    CHECK(a.samples[i].nominal == b.samples[i].nominal);
    CHECK(a.samples[i].limits.upper == b.samples[i].limits.upper);
  }
  CHECK(a.traps.size() == b.traps.size());
}

std::string messages(const Sink& sink) {
  std::string out;
  for (const Diagnostic& d : sink.sorted()) out += render(d);
  return out;
}

}  // namespace

TEST_CASE("machines that part by what they measure get exactly what each gets alone") {
  const Machine machine = read_machine("coord3-mc16");
  const VirtualMachines machines = screened_machines(machine, 1, 40, 1);
  std::size_t parted = 0;
  for (std::uint32_t number = 1; number <= 25; ++number) {
    const SourceFile source("random.dmi", Author(number).program());
    Sink sink;
    const plan::Plan plan = lang::compile(source, sink).plan;
    INFO(source.text());
    INFO(messages(sink));
    REQUIRE_FALSE(sink.has_errors());
    const RunResult alone = run(plan, machine, machines, 1, source);
    REQUIRE(alone.samples.size() >= 5);
    for (const Samples& s : alone.samples) parted += s.value.size() < 40 ? 1 : 0;
    check_same(alone, run(plan, machine, machines, 7, source));
    check_same(alone, run(plan, machine, machines, 128, source));
  }
  CHECK(parted > 5);
}

TEST_CASE("what only virtual machines evaluate has samples, but no reference") {
  const SourceFile source(
      "branches.dmi",
      "DMISMN/'branches',5.2\nDECL/REAL,D\nS(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,150,4\nSNSLCT/S(P)\n"
      "D(R)=TRANS/XORIG,700,YORIG,400,ZORIG,-500\nF(H)=FEAT/CIRCLE,INNER,CART,50,30,-5,0,0,1,10\n"
      "MEAS/CIRCLE,F(H),6\nENDMES\nD=OBTAIN/FA(H),11\nIF/(D .GT. 10.0001)\nT(BIG)=TOL/DIAM,-0.01,0.01\n"
      "EVAL/FA(H),TA(BIG)\nELSE\nT(SMALL)=TOL/DIAM,-0.02,0.02\nEVAL/FA(H),TA(SMALL)\nENDIF\nENDFIL\n");
  Sink sink;
  const plan::Plan plan = lang::compile(source, sink).plan;
  INFO(messages(sink));
  REQUIRE_FALSE(sink.has_errors());
  const Machine machine = read_machine("coord3-mc16");
  const RunResult r = run(plan, machine, screened_machines(machine, 1, 60, 1), 7, source);
  REQUIRE(r.samples.size() == 2);
  const Samples &small = r.samples[0], &big = r.samples[1];
  CHECK(*small.reference == doctest::Approx(10).epsilon(1e-12));
  CHECK_FALSE(big.reference);
  CHECK(big.nominal == 10);
  CHECK(*big.limits.upper == doctest::Approx(10.01).epsilon(1e-12));
  CHECK(big.value.size() > 2);
  CHECK(small.value.size() > 2);
  CHECK(small.value.size() + big.value.size() == 60);
  for (const double d : big.value) CHECK(d > 10.0001);
  CHECK(r.traps.empty());
  CHECK(counterpart(r.samples, 1, r) == &big);
  RunResult other;
  other.samples = {big};
  CHECK(counterpart(r.samples, 1, other) == &other.samples[0]);
  CHECK(counterpart(r.samples, 0, other) == nullptr);
}
