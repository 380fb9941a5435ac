// abbe_bench: what docs/benchmarks.md records, measured inside one process on one thread. Costs are per
// candidate, touch or machine, at several sizes, so that their growth shows. `abbe_bench program` prints the
// large program that one of the benchmarks runs, `abbe_bench conditions` measures only how compiling grows
// with conditions.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "engine/effects/effect.hpp"
#include "engine/run/executor.hpp"
#include "engine/run/run.hpp"
#include "lang/compile.hpp"

namespace {

using namespace abbe;

/// Median processor time of some calls, s: other users of the computer do not change it much.
double seconds(const std::function<void()>& work, int calls = 5) {
  std::vector<double> times;
  for (int i = 0; i < calls; ++i) {
    const std::clock_t begin = std::clock();
    work();
    times.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  std::nth_element(times.begin(), times.begin() + calls / 2, times.end());
  return times[static_cast<std::size_t>(calls / 2)];
}

/// A program that measures a sphere with 25 touches so many times and evaluates its diameter each time.
SourceFile spheres(int count) {
  std::string text =
      "DMISMN/'bench',5.2\nUNITS/MM,ANGDEC\nPRCOMP/ON\nS(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\nSNSLCT/S(P)\n"
      "D(B)=TRANS/XORIG,800,YORIG,500,ZORIG,-500\nF(BALL)=FEAT/SPHERE,OUTER,CART,0,0,0,25\nT(DIA)=TOL/DIAM,-0.01,0.01\n";
  for (int i = 0; i < count; ++i) {
    text += "MEAS/SPHERE,F(BALL),25\n";
    for (int k = 0; k < 25; ++k) {
      const double z = k / 25.0, a = 2.4 * k, r = std::sqrt(1 - z * z);  // a spiral from the equator towards the pole
      const Vec3 n{r * std::cos(a), r * std::sin(a), z};
      text += fmt::format("PTMEAS/CART,{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f}\n", 12.5 * n.x, 12.5 * n.y, 12.5 * n.z,
                          n.x, n.y, n.z);
    }
    text += "ENDMES\nOUTPUT/FA(BALL),TA(DIA)\n";
  }
  return SourceFile("bench", text + "ENDFIL\n");
}

/// Circles and planes in turn, in the manner of production software: every feature with moves, tolerance and
/// output of its own; now and then a macro, a loop, and a condition on what was measured. 28.6 lines a
/// feature: 700 of them make 20 000 lines.
std::string large_program(int features) {
  std::string text =
      "DMISMN/'large',5.2\nUNITS/MM,ANGDEC\nPRCOMP/ON\nDECL/REAL,X,Y\nDECL/INTGR,I\nS(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\nSNSLCT/S(P)\n"
      "D(B)=TRANS/XORIG,500,YORIG,300,ZORIG,-500\nM(REPORT)=MACRO/'NAME','TOLERANCE',SIZE\nT('TOLERANCE')=TOL/DIAM,-SIZE,SIZE\nOUTPUT/FA('NAME'),TA('TOLERANCE')\nENDMAC\n";
  for (int f = 0; f < features; ++f) {
    const double x = 20.0 * (f % 30), y = 20.0 * (f / 30 % 24);
    const bool round = f % 2 == 0;
    text += fmt::format("$$ feature {0}\nF(F{0})=FEAT/{1}\nGOTO/{2},{3},20\nMEAS/{4},F(F{0}),8\n", f,
                        round ? fmt::format("CIRCLE,INNER,CART,{},{},-5,0,0,1,10", x, y)
                              : fmt::format("PLANE,CART,{},{},0,0,0,1", x, y),
                        x, y, round ? "CIRCLE" : "PLANE");
    for (int k = 0; k < 8; ++k) {
      const double a = kPi / 4 * k, i = std::cos(a), j = std::sin(a);
      text += fmt::format("GOTO/{:.4f},{:.4f},{}\n", x + 2 * i, y + 2 * j, round ? -5 : 5);
      text += round ? fmt::format("PTMEAS/CART,{:.6f},{:.6f},-5,{:.6f},{:.6f},0\n", x + 5 * i, y + 5 * j, -i, -j)
                    : fmt::format("PTMEAS/CART,{:.6f},{:.6f},0,0,0,1\n", x + 4 * i, y + 4 * j);
    }
    text += fmt::format("ENDMES\nX=OBTAIN/FA(F{}),{}\n", f, round ? 5 : 4);
    text += round ? fmt::format("CALL/M(REPORT),'F{0}','T{0}',0.05\n", f)
                  : fmt::format("T(T{0})=TOL/FLAT,0.02\nOUTPUT/FA(F{0}),TA(T{0})\n", f);
    if (f % 4 == 0) text += fmt::format("IF/(X .GT. {})\nGOTO/{},{},30\nENDIF\n", x, x, y);
    if (f % 4 == 2) text += fmt::format("DO/I,1,3\nGOTO/{},{}+I,30\nENDDO\n", x, y);
    text += "$$\nSNSET/APPRCH,2\nSNSET/RETRCT,2\n";
  }
  return text + "ENDFIL\n";
}

/// The most memory that this process has held so far, MB.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  double kilobytes = 0;
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) std::istringstream(line.substr(6)) >> kilobytes;
  return kilobytes / 1024;
}

void large_programs(const Machine& machine) {
  fmt::print(
      "\n lines  features  operations  machines   compile, s   run, s   one machine holds, KB   peak memory, MB\n");
  for (const auto& [features, count] :
       {std::pair{175, 1000}, {350, 1000}, {700, 250}, {700, 1000}, {700, 4000}, {3500, 1000}}) {
    const SourceFile source("large", large_program(features));
    plan::Plan plan;
    const double compile = seconds(
        [&] {
          Sink sink;
          plan = lang::compile(source, sink).plan;
          ABBE_CHECK(!sink.has_errors());
        },
        3);
    const VirtualMachines machines = screened_machines(machine, 1, count, 1);
    const double run = seconds([&] { run_plan(plan, machine, machines, {}, source); }, 1);
    const double held = static_cast<double>(Executor(plan, machine, {}, source).lane_bytes()) / 1024;
    fmt::print("{:6}  {:8}  {:10}  {:8}   {:10.3f}   {:6.2f}   {:21.1f}   {:15.0f}\n", source.line_count(),
               plan.features.size(), plan.operations.size(), count, compile, run, held, peak_memory());
  }
}

/// A program with as many conditions on measured values as features: after each the compiler cannot know
/// which path was taken.
std::string conditions_program(int conditions) {
  std::string text =
      "DMISMN/'conditions',5.2\nUNITS/MM,ANGDEC\nDECL/REAL,X\nS(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,100,4\nSNSLCT/S(P)\n";
  for (int f = 0; f < conditions; ++f)
    text += fmt::format(
        "F(F{0})=FEAT/POINT,CART,0,0,0,0,0,1\nT(T{0})=TOL/CORTOL,ZAXIS,-0.1,0.1\nMEAS/POINT,F(F{0}),1\nPTMEAS/CART,0,0,0,0,0,1\nENDMES\n"
        "OUTPUT/FA(F{0}),TA(T{0})\nX=OBTAIN/FA(F{0}),5\nIF/(X .GT. 0)\nGOTO/0,0,30\nENDIF\n",
        f);
  return text + "ENDFIL\n";
}

void conditions() {
  fmt::print("\nconditions   compile, s   per condition, us\n");
  for (const int count : {175, 350, 700, 1400, 2800}) {
    const SourceFile source("conditions", conditions_program(count));
    const double t = seconds([&] {
      Sink sink;
      lang::compile(source, sink);
      ABBE_CHECK(!sink.has_errors());
    });
    fmt::print("{:10}   {:10.3f}   {:17.1f}\n", count, t, 1e6 * t / count);
  }
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

void screening(const Machine& machine) {
  fmt::print("\nmachines   drawn   draw and screen, s   per candidate, us\n");
  for (const int count : {250, 1000, 4000}) {
    VirtualMachines machines;
    const double t = seconds([&] { machines = screened_machines(machine, 1, count, 1); });
    fmt::print("{:8}  {:6}   {:18.4f}   {:17.2f}\n", count, machines.counts.generated, t,
               1e6 * t / static_cast<double>(machines.counts.generated));
  }
}

/// Time of one touch on one machine, ns.
double touch_ns(const Machine& machine, int sphere_count, int machine_count) {
  const SourceFile source = spheres(sphere_count);
  Sink sink;
  const plan::Plan plan = lang::compile(source, sink).plan;
  ABBE_CHECK(!sink.has_errors());
  Machine bare = machine;
  bare.effects.clear();
  const VirtualMachines machines = screened_machines(bare, 1, machine_count, 1);
  RunResult result;
  const double t = seconds([&] { result = run_plan(plan, machine, machines, {}, source); });
  return 1e9 * t / static_cast<double>(result.touches);
}

void touches(const Machine& machine) {
  fmt::print("\ntouches  machines   one touch on one machine, ns (fit and evaluation included)\n");
  for (const auto& [count, machines] : {std::pair{4, 1000}, {40, 1000}, {400, 1000}, {40, 250}, {40, 4000}})
    fmt::print("{:7}  {:8}   {:.0f}\n", 25 * count, machines, touch_ns(machine, count, machines));
}

void effects_cost(Machine machine) {
  const double plain = touch_ns(machine, 40, 1000);
  for (const Effect* effect : effects()) {
    EffectSetting setting{std::string(effect->name), {}};
    const EffectParameter& size = effect->parameters[0];
    setting.parameters[std::string(size.name)] = {size.typical, size.typical / 10, ""};
    machine.effects.push_back(setting);
  }
  const double all = touch_ns(machine, 40, 1000);
  fmt::print("\none touch without effects {:.0f} ns, with all {} effects uncertain {:.0f} ns: {:.1f} times\n", plain,
             effects().size(), all, all / plain);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "program") {
    fmt::print("{}", large_program(700));
    return 0;
  }
  if (argc > 1 && std::string_view(argv[1]) == "conditions") {
    conditions();
    return 0;
  }
  fmt::print("{}; one thread; medians of five\n", processor());
  const Machine machine = read_machine("coord3-mc16");
  large_programs(machine);
  conditions();
  screening(machine);
  touches(machine);
  effects_cost(machine);
}
