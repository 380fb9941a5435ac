#include "tests/fuzz/recordings.hpp"

#include <string>

#include "engine/machine/machine.hpp"
#include "engine/recording/recording.hpp"
#include "engine/recording/value_recording.hpp"
#include "engine/run/recorded/sensor_lines.hpp"
#include "engine/run/recorded/touch.hpp"
#include "lang/result_reader.hpp"
#include "tests/fuzz/programs.hpp"

namespace abbe::fuzz {

namespace {

const std::string kTouches =
    R"CSV(# sensor DOWN: head_deg 0 0 tip_in_r_mm 0 0 -150 diameter_mm 4 shaft_diameter_mm 2 young_GPa 620
# frame: mcs
# point: tip_centre
# surfaces: calibrated
feature,touch,x,y,z,tx,ty,tz,nx,ny,nz,setup,run,sensor,head_A_deg,head_B_deg,visit,time_s,speed_mm_s,accel_mm_s2
BALL,1,800.0001,500,-585.4994,800,500,-585.5,0,0,1,1,1,DOWN,0,0,1,10.023,5,500
BALL,2,814.5003,500,-600,814.5,500,-600,1,0,0,1,1,DOWN,0,0,1,11.117,5,500
BALL,3,800,514.4998,-600,800,514.5,-600,0,1,0,1,1,DOWN,0,0,1,12.252,5,500
"FACE, left",1,700.0002,500,-600,700,500,-600,-1,0,0,1,2,DOWN,0,0,2,13.387,5,500
)CSV";

const std::string kValues = R"CSV(# machine: coord3-mc16
characteristic,program,artefact,value,reference,U,run,occurrence
LEN,x1_S.dmi,block S,100.0005,99.99978,0.00012,1,1
LEN,x1_S.dmi,block S,100.0007,99.99978,0.00012,2,1
"FA(A), TA(DIA)",ring.dmi,,49.9999,,,1,2
)CSV";

const std::string kResult = R"CSV(FILNAM/'ring'
UNITS/MM, ANGDEC
OUTPUT/FA(BORE), TA(DIA), TA(TILT)
FA(BORE) = FEAT/CIRCLE, INNER, CART, 0.00002, -0.00004, -10.00000, 0.0, 0.0, 1.0, 50.00004
TA(DIA) = TOL/DIAM, 50.00004, INTOL
$$ ! u TA(DIA) 0.00052 lcl -0.00101 ucl 0.00104 conforms 0.98
TA(TILT) = TOL/ANGLB, 90:00:01, OUTOL
DA(R) = DATSET/TRMATX, 1, 0, 0, 0, 1, 0, 0, 0, 1, 800.0, 500.0, -500.0
ENDFIL
)CSV";

template <class Read>
int is_read(Read read) {
  try {
    read();
    return 1;
  } catch (const UserError&) {
    return 0;
  }
}

void read_touches(const std::string& text) {
  static const Machine known = read_machine("coord3-mc16");
  const SourceFile file("fuzz.csv", text);
  is_value_recording(file);
  const Recording recording = read_recording(file, Positions::or_targets);
  Machine machine = known;
  std::vector<Diagnostic> messages;
  add_recorded_sensors(recording, machine, file.name(), messages);
  recorded_touches(recording, machine, file.name());
  to_csv(recording);
}

void read_values(const std::string& text) {
  for (const ValueRow& row : read_value_recording(SourceFile("fuzz.csv", text)).rows) labels_of(row.characteristic);
}

void read_result(const std::string& text) {
  Sink sink;
  lang::read_dmis_result(SourceFile("fuzz.dmo", text), sink);
  if (sink.has_errors()) throw UserError(sink.list());
}

}  // namespace

int exercise_recordings(std::mt19937& random) {
  return is_read([&] { read_touches(damaged(kTouches, kValues, random)); }) +
      is_read([&] { read_values(damaged(kValues, kTouches, random)); }) +
      is_read([&] { read_result(damaged(kResult, kTouches, random)); });
}

}  // namespace abbe::fuzz
