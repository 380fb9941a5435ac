// How the machine moves and what a touch yields: SNSET, FEDRAT, ACLRAT, FLY, PRCOMP.
#include <fmt/format.h>

#include "engine/math/units.hpp"
#include "lang/statement.hpp"

namespace abbe::lang {

namespace {

using plan::MotionSetting;

void set_sensor_path(Lowering& lowering, const RawStatement&, const Match& match) {
  const std::string word = match.text("setting");
  if (const MatchedValue* surface = match.find("surface"))
    return lowering.warn(Code::W0122, surface->span, fmt::format("{} of a surface is skipped", word),
                         "nothing depends on it: collisions are not looked for");
  const MotionSetting setting = word == "APPRCH" ? MotionSetting::approach
      : word == "SEARCH"                         ? MotionSetting::search
      : word == "RETRCT"                         ? MotionSetting::retract
      : word == "CLRSRF"                         ? MotionSetting::clearance
                                                 : MotionSetting::depth;
  if (const MatchedValue* distance = match.find("distance"); distance && distance->number < 0)
    return lowering.error(Code::E0106, distance->span, fmt::format("the distance of {} is less than zero", word),
                          "give how far it is, without a sign");
  lowering.emit(plan::SetMotion{setting, match.number("distance", 0)});
}

/// DEFALT, HIGH or LOW: the machine file gives one figure, which is its greatest and its usual one.
void set_level(Lowering& lowering, MotionSetting setting, const MatchedValue& level) {
  if (level.text != "DEFALT")
    lowering.warn(Code::W0122, level.span, fmt::format("how much {} is, no machine file says", level.text),
                  "the machine's own figure is used; give a number, or per cent of it with PCENT");
  lowering.emit(plan::SetMotion{setting, 100, true});
}

/// What says how fast the machine moves divides lengths.
bool moves(Lowering& lowering, const Match& match, std::string_view what) {
  const MatchedValue& value = *match.find("value");
  if (value.number > 0) return true;
  lowering.error(Code::E0106, value.span, fmt::format("{} of {:g} moves nothing", what, value.number),
                 "give a number greater than zero");
  return false;
}

void set_speed(Lowering& lowering, const RawStatement&, const Match& match) {
  if (!match.has("speed")) return;  // ROTVEL, HEDVEL: the time that table and head take is not reckoned with
  const std::string what = match.text("speed"), unit = match.text("unit");
  const MotionSetting setting = what == "POSVEL" ? MotionSetting::positioning_speed
      : what == "MESVEL"                         ? MotionSetting::measuring_speed
                                                 : MotionSetting::scan_speed;
  if (const MatchedValue* level = match.find("level")) return set_level(lowering, setting, *level);
  if (!moves(lowering, match, "a speed")) return;
  const double mm = unit == "MPM" ? 1000 : unit.starts_with("IP") ? kMmPerInch : 1;
  const double seconds = unit.ends_with("PM") ? 60 : 1;
  lowering.emit(plan::SetMotion{setting, match.number("value") * mm / seconds, unit == "PCENT"});
}

void set_acceleration(Lowering& lowering, const RawStatement&, const Match& match) {
  if (!match.has("acceleration")) return;
  const MotionSetting setting = match.text("acceleration") == "POSACL" ? MotionSetting::positioning_acceleration
                                                                       : MotionSetting::measuring_acceleration;
  if (const MatchedValue* level = match.find("level")) return set_level(lowering, setting, *level);
  if (!moves(lowering, match, "an acceleration")) return;
  const std::string unit = match.text("unit");
  const double mm = unit == "MPMM" ? 1000 : unit.starts_with("IP") ? kMmPerInch : 1;
  const double square_seconds = unit == "MPMM" || unit == "IPMM" ? 3600 : 1;
  lowering.emit(plan::SetMotion{setting, match.number("value") * mm / square_seconds, unit == "PCENT"});
}

void set_fly(Lowering& lowering, const RawStatement&, const Match& match) {
  if (const MatchedValue* radius = match.find("radius"); radius && radius->number < 0)
    return lowering.error(Code::E0106, radius->span, "the radius of FLY is less than zero",
                          "give a length, or FLY/OFF to stop at every position");
  lowering.emit(plan::SetMotion{MotionSetting::fly_radius, match.number("radius", 0)});
}

void set_compensation(Lowering& lowering, const RawStatement&, const Match& match) {
  lowering.emit(plan::SetCompensation{match.text("state") == "ON"});
}

}  // namespace

extern const Statement kSnset, kFedrat, kAclrat, kFly, kPrcomp;

const Statement kSnset = {
    .word = "SNSET",
    .signature =
        "( setting:APPRCH|SEARCH|RETRCT|CLRSRF|DEPTH, distance:length ; setting:CLRSRF|DEPTH, OFF ; "
        "setting:CLRSRF|DEPTH, ( surface:feature ; surface:datum ), [ distance:length ] )",
    .help =
        "Distances of a touch: from where it starts (APPRCH), how far it searches (SEARCH), how far it "
        "retracts (RETRCT). CLRSRF and DEPTH, which keep clear of surfaces, are skipped.",
    .example = "SNSET/APPRCH,5.0",
    .source = "ISO 22093, SNSET",
    .lower = set_sensor_path,
    .doubt = Doubt::one_setting,
};
const Statement kFedrat = {
    .word = "FEDRAT",
    .signature =
        "( speed:POSVEL|MESVEL|SCNVEL, ( unit:MPM|MMPS|IPM|IPS|PCENT, value:number ; level:DEFALT|HIGH|LOW ) ; ROTVEL|HEDVEL, ... )",
    .help =
        "Speed of positioning, touching and scanning. PCENT: per cent of the machine's greatest speed; "
        "DEFALT: that speed. "
        "ROTVEL and HEDVEL, of a rotary table and a head, are skipped.",
    .example = "FEDRAT/POSVEL,MPM,1.8",
    .source = "ISO 22093, FEDRAT",
    .lower = set_speed,
    .doubt = Doubt::one_setting,
};
const Statement kAclrat = {
    .word = "ACLRAT",
    .signature =
        "( acceleration:POSACL|MESACL, ( unit:MPMM|MMPSS|IPMM|IPSS|PCENT, value:number ; level:DEFALT|HIGH|LOW ) ; "
        "SCNACL|HEDACL|ROTACL, ... )",
    .help =
        "Acceleration of positioning and touching: m/min2, mm/s2, inch/min2, inch/s2, per cent or the machine's own (DEFALT). "
        "SCNACL, HEDACL and ROTACL, of scanning, a head and a rotary table, are skipped.",
    .example = "ACLRAT/MESACL,MMPSS,100",
    .source = "ISO 22093, ACLRAT",
    .lower = set_acceleration,
    .doubt = Doubt::one_setting,
};
const Statement kFly = {
    .word = "FLY",
    .signature = "( radius:length ; OFF )",
    .help = "Passes intermediate positions within this radius instead of stopping there.",
    .example = "FLY/5.0",
    .source = "ISO 22093, FLY",
    .lower = set_fly,
    .doubt = Doubt::setting,
};
const Statement kPrcomp = {
    .word = "PRCOMP",
    .signature = "state:ON|OFF",
    .help = "ON: a touch yields the point of the surface. OFF: the centre of the tip.",
    .example = "PRCOMP/ON",
    .source = "ISO 22093, PRCOMP",
    .lower = set_compensation,
    .doubt = Doubt::setting,
};

}  // namespace abbe::lang
