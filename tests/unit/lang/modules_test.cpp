// Modules: what is said of them and where, while they are read and after they are gone.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>

#include "lang/compile.hpp"

using namespace abbe;
using namespace abbe::lang;

namespace {

struct CompiledBeside {
  Compilation result;
  Sink sink;

  int lines_with(Code code, int line) const {
    return static_cast<int>(std::count_if(sink.list().begin(), sink.list().end(),
                                          [&](const Diagnostic& d) { return d.code == code && d.place.line == line; }));
  }
};

/// A program that lies beside the modules of tests/lang.
CompiledBeside compile_beside_modules(const std::string& text) {
  CompiledBeside out;
  out.result = compile(SourceFile(std::string(ABBE_SOURCE_DIR) + "/tests/lang/modules/program.dmi", text), out.sink);
  return out;
}

}  // namespace

TEST_CASE("what follows a module that never ends is checked in the program") {
  for (const std::string module : {"itself", "endless"}) {
    INFO(module);
    const CompiledBeside c =
        compile_beside_modules(fmt::format("DMISMN/'a',5.2\nINCLUD/DMIS,'{}'\nFOOBAR/1\n", module));
    CHECK(c.lines_with(module == "itself" ? Code::E0237 : Code::E0120, module == "itself" ? 2 : 3) == 1);
    CHECK(c.lines_with(Code::E0110, 3) == 1);
  }
}

TEST_CASE("definitions in a module have the place of its call") {
  const CompiledBeside c =
      compile_beside_modules("DMISMN/'a',5.2\nINCLUD/DMIS,'long_preface'\nT(1)=TOL/FLAT,0.2\nENDFIL\n");
  const SourceFile program("program.dmi", "DMISMN/'a',5.2\nINCLUD/DMIS,'long_preface'\n");
  REQUIRE(c.result.plan.sensors.size() == 2);
  for (const plan::SensorDef& sensor : c.result.plan.sensors) CHECK(program.place(sensor.span.begin).line == 2);
  REQUIRE(c.lines_with(Code::N0611, 3) == 1);
  CHECK(c.sink.list()[0].message == "T(1) was another tolerance in line 2");
}

TEST_CASE("a measurement that a module leaves open is one of its call") {
  const CompiledBeside c = compile_beside_modules(
      "DMISMN/'a',5.2\nSNSLCT/SA(PROBE)\nF(P)=FEAT/PLANE,CART,0,0,0,0,0,1\nINCLUD/DMIS,'open_measurement'\nENDFIL\n");
  CHECK(c.lines_with(Code::E0205, 4) == 1);
}

TEST_CASE("tolerances of two modules are two, wherever they stand in them") {
  const CompiledBeside c = compile_beside_modules(
      "DMISMN/'a',5.2\nDECL/REAL,X\nSNSLCT/SA(PROBE)\nF(P)=FEAT/PLANE,CART,0,0,0,0,0,1\nMEAS/PLANE,F(P),4\nENDMES\n"
      "X=OBTAIN/FA(P),5\nIF/(X .GT. 0)\nINCLUD/DMIS,'flat_a'\nELSE\nINCLUD/DMIS,'flat_b'\nENDIF\nOUTPUT/FA(P),TA(1)\n"
      "ENDFIL\n");
  CHECK(c.lines_with(Code::E0238, 13) == 1);
}

TEST_CASE("a macro that defines the tolerance again that is known may be called in a loop") {
  const auto refused = [](const std::string& value) {
    return compile_beside_modules(
               "DMISMN/'a',5.2\nDECL/REAL,X\nSNSLCT/SA(PROBE)\nF(P)=FEAT/PLANE,CART,0,0,0,0,0,1\n"
               "M(CHECK)=MACRO/V\nT(1)=TOL/FLAT,V\nMEAS/PLANE,F(P),4\nENDMES\nX=OBTAIN/FA(P),5\nOUTPUT/FA(P),TA(1)\n"
               "ENDMAC\nCALL/M(CHECK),0.1\n(AGAIN)\nCALL/M(CHECK)," +
               value + "\nIF/(X .GT. 0)\nJUMPTO/(AGAIN)\nENDIF\nENDFIL\n")
        .lines_with(Code::E0238, 16);
  };
  CHECK(refused("0.1") == 0);
  CHECK(refused("0.2") == 1);
}
