// Programs written as text, compiled and run: for tests of what statements mean.
#pragma once

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>

#include "engine/run/run.hpp"
#include "lang/compile.hpp"

namespace abbe::test {

/// The beginning of a program: a stylus, and a coordinate system in the middle of the machine.
inline const std::string kStart =
    "DMISMN/'test',5.2\nUNITS/MM,ANGDEC\nS(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,150,4\nSNSLCT/S(P)\n"
    "D(PART)=TRANS/XORIG,700,YORIG,400,ZORIG,-500\n";

/// Statements that measure a feature: `points` are "x,y,z,i,j,k" each.
inline std::string measured(const std::string& label, const std::string& form, const std::vector<std::string>& points,
                            const std::string& begin = "MEAS/{},F({}),{}", const std::string& after = "") {
  std::string out = fmt::format("F({})=FEAT/{}\n", label, form);
  out += fmt::format(fmt::runtime(begin), form.substr(0, form.find(',')), label, points.size()) + after + "\n";
  for (const std::string& p : points) out += "PTMEAS/CART," + p + "\n";
  return out + "ENDMES\n";
}

/// kStart, the statements and ENDFIL, on the shipped machine. The program must be without errors.
struct Ran {
  plan::Plan plan;
  RunResult result;

  explicit Ran(const std::string& statements, int machines = 0, RunOptions options = {}) {
    const SourceFile source("test.dmi", kStart + statements + "ENDFIL\n");
    Sink sink;
    plan = lang::compile(source, sink).plan;
    std::string messages;
    for (const Diagnostic& d : sink.sorted()) messages += render(d);
    INFO(messages);
    REQUIRE_FALSE(sink.has_errors());
    const Machine machine = read_machine("coord3-mc16");
    result = run_plan(plan, machine, machines > 0 ? screened_machines(machine, 1, machines, 1) : VirtualMachines{},
                      options, source);
  }
  /// What was evaluated of the tolerance first.
  const Samples& samples(const std::string& tolerance) const {
    for (const Samples& s : result.samples)
      if (plan[plan[s.characteristic].tolerance].label == tolerance) return s;
    FAIL("not evaluated: ", tolerance);
    throw std::logic_error(tolerance);
  }
  /// Its value on the error-free machine.
  double operator[](const std::string& tolerance) const { return samples(tolerance).reference.value(); }
  /// The feature as the error-free machine put it out last, in the system current there.
  const Element& output(const std::string& feature) const {
    for (auto record = result.reference_outputs.rbegin(); record != result.reference_outputs.rend(); ++record) {
      const auto* what =
          std::get_if<plan::Output>(&plan.operations[static_cast<std::size_t>(record->operation)].action);
      for (std::size_t k = 0; what && k < what->features.size(); ++k)
        if (plan[what->features[k]].label == feature) return record->features[k];
    }
    FAIL("not put out: ", feature);
    throw std::logic_error(feature);
  }
};

inline void check_near(const Vec3& is, const Vec3& expected, double within = 1e-6) {
  CAPTURE(is.x);
  CAPTURE(is.y);
  CAPTURE(is.z);
  CHECK(norm(is - expected) < within);
}

}  // namespace abbe::test
