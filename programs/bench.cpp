// abbe_bench: what docs/benchmarks.md records, measured inside one process on one thread. Costs are per candidate, touch or machine, at
// several sizes, so that their growth shows.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "engine/effects/effect.hpp"
#include "engine/run/run.hpp"
#include "lang/compile.hpp"

namespace {

using namespace abbe;

/// Median time of five calls, s.
double seconds(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < 5; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::nth_element(times.begin(), times.begin() + 2, times.end());
  return times[2];
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
      text += fmt::format("PTMEAS/CART,{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f}\n", 12.5 * n.x, 12.5 * n.y, 12.5 * n.z, n.x, n.y, n.z);
    }
    text += "ENDMES\nOUTPUT/FA(BALL),TA(DIA)\n";
  }
  return SourceFile("bench", text + "ENDFIL\n");
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
    fmt::print("{:8}  {:6}   {:18.4f}   {:17.2f}\n", count, machines.counts.generated, t, 1e6 * t / static_cast<double>(machines.counts.generated));
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
  fmt::print("\none touch without effects {:.0f} ns, with all {} effects uncertain {:.0f} ns: {:.1f} times\n", plain, effects().size(), all, all / plain);
}

}  // namespace

int main() {
  fmt::print("{}; one thread; medians of five\n", processor());
  const Machine machine = read_machine("coord3-mc16");
  screening(machine);
  touches(machine);
  effects_cost(machine);
}
