// Handlers of constructions, coordinate systems and evaluations.
#include <algorithm>

#include "engine/features/shape_traits.hpp"
#include "engine/run/block_run.hpp"

namespace abbe {

Element BlockRun::nominal_of(Lane& lane, plan::FeatureId feature) {
  const FeatureState& own = state(lane, feature);
  if (own.own_nominal) return inverse(lane.X_WD) * own.nominal;
  Lane& nominal = nominal_lane_of(lane);
  return inverse(nominal.X_WD) * state(nominal, feature).nominal;
}

namespace {

/// The point of a line or axis that is nearest to q.
Vec3 foot_on_axis(const Element& axis, const Vec3& q) {
  return axis.point + dot(q - axis.point, axis.direction) * axis.direction;
}

/// The touches of both faces; none when it is not known how far one of them reaches.
std::vector<Vec3> faces_between(const FeatureState& a, const FeatureState& b) {
  std::vector<Vec3> both = a.touched.empty() ? a.faces : a.touched;
  const std::vector<Vec3>& others = b.touched.empty() ? b.faces : b.touched;
  if (both.empty() || others.empty()) return {};
  both.insert(both.end(), others.begin(), others.end());
  return both;
}

}  // namespace

void BlockRun::operator()(const plan::Construct& construct) {
  const Shape shape = executor.plan_[construct.result].kind->acts_as;
  std::vector<Shape> shapes;
  for (const plan::FeatureId id : construct.from) shapes.push_back(executor.plan_[id].kind->acts_as);
  std::vector<Element> from(shapes.size());
  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    Lane& twin = twin_of(lane);
    const Rigid X_DW = inverse(lane.X_WD);
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const Element* element = actual(i, construct.from[k]);
      if (!element) return "";
      from[k] = X_DW * *element;
      if (construct.method->axes_are_points && (shapes[k] == Shape::line || shapes[k] == Shape::cylinder))
        from[k].point = foot_on_axis(from[k], nominal_of(lane, construct.from[k]).point);
    }
    const Element nominal = inverse(twin.X_WD) * state(twin, construct.result).nominal;
    const Outcome<Element> made =
        construct.method->construct(shape, shapes, from, nominal, filled(lane, construct.arguments, construct.varying));
    if (!made) return made.failure;
    Element element = made.value;
    if (shape == Shape::line) element.second = nominal.second;  // the normal of its surface
    std::vector<Vec3> faces;
    if (construct.method->lies_between)
      faces = faces_between(state(lane, construct.from[0]), state(lane, construct.from[1]));
    FeatureState& result = state(lane, construct.result);
    result.actual = lane.X_WD * element;
    result.touched.clear();
    result.faces = std::move(faces);
    result.has_actual = true;
    return "";
  });
}

Element BlockRun::programmed(Lane& lane, plan::FeatureId feature) {
  const FeatureState &own = state(lane, feature), &true_one = state(twin_of(lane), feature);
  return own.own_nominal ? own.nominal : own.defined_in * (inverse(true_one.defined_in) * true_one.nominal);
}

void BlockRun::operator()(const plan::TakeNominal& take) {
  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    const FeatureState& of = state(lane, take.of);
    if (!of.definition.valid())
      return "feature '" + executor.plan_[take.of].label + "' was not defined on the path that was taken";
    FeatureState& result = state(lane, take.result);
    result = of;
    result.feature = take.result;
    result.actual = programmed(lane, take.of);
    result.has_actual = true;
    result.touched.clear();
    result.faces.clear();
    result.meant.clear();
    return "";
  });
}

void BlockRun::set_frame(Lane& lane, plan::FrameId id, const Rigid& X_WD) {
  lane.X_WD = X_WD;
  lane.frames[id.value] = X_WD;
}

void BlockRun::operator()(const plan::SetMachineFrame& set) {
  for (const int i : active) set_frame(block.lanes[i], set.result, {Mat3{}, executor.options_.placement_mm});
}

void BlockRun::operator()(const plan::SetMatrixFrame& set) {
  for (const int i : active)
    set_frame(block.lanes[i], set.result, Rigid{Mat3{}, executor.options_.placement_mm} * set.X_MD);
}

void BlockRun::operator()(const plan::SetDatumFrame& set) {
  std::vector<DatumUse> uses(set.datums.size());
  for_active([&](int i) -> std::string {
    for (std::size_t k = 0; k < uses.size(); ++k) {
      const plan::DatumRef& datum = set.datums[k];
      const Element* element = actual(i, datum.feature);
      if (!element) return "";
      uses[k] = {executor.plan_[datum.feature].kind->acts_as,
                 *element,
                 datum.gives_direction,
                 datum.direction,
                 {datum.origin[0], datum.origin[1], datum.origin[2]}};
    }
    const Outcome<Rigid> made = datum_frame(block.lanes[i].X_WD, uses);
    if (!made) return made.failure;
    set_frame(block.lanes[i], set.result, made.value);
    return "";
  });
}

void BlockRun::operator()(const plan::TranslateFrame& translate) {
  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    Vec3 shift_D;
    for (const plan::OriginShift& shift : translate.shifts) {
      const int axis = static_cast<int>(shift.axis);
      if (!shift.from.valid()) {
        shift_D[axis] += value(lane, shift.by);
        continue;
      }
      const Element* element = actual(i, shift.from);
      if (!element) return "";
      const Vec3 there = location_of(executor.plan_[shift.from].kind->acts_as, *element);
      shift_D[axis] += (inverse(lane.X_WD) * there)[axis];
    }
    set_frame(lane, translate.result, {lane.X_WD.R, lane.X_WD * shift_D});
    return "";
  });
}

void BlockRun::operator()(const plan::RotateFrame& rotate) {
  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    if (!rotate.to.valid()) {
      Vec3 axis;
      axis[static_cast<int>(rotate.axis)] = 1;
      set_frame(lane, rotate.result, {lane.X_WD.R * rotation(axis, value(lane, rotate.angle_rad)), lane.X_WD.p});
      return "";
    }
    const Element* element = actual(i, rotate.to);
    if (!element) return "";
    const Shape shape = executor.plan_[rotate.to].kind->acts_as;
    const Outcome<Rigid> made = rotated_to(lane.X_WD, rotate.axis, shape, *element, rotate.toward);
    if (!made) return made.failure;
    set_frame(lane, rotate.result, made.value);
    return "";
  });
}

void BlockRun::operator()(const plan::RecallFrame& recall) {
  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    if (!lane.frames[recall.frame.value])
      return "coordinate system '" + executor.plan_[recall.frame].label + "' was not set on the path that was taken";
    lane.X_WD = *lane.frames[recall.frame.value];
    return "";
  });
}

std::vector<TouchedPoint> BlockRun::touches_of(Lane& lane, plan::FeatureId feature) {
  Lane& nominal = nominal_lane_of(lane);
  const std::vector<Vec3>& points = state(lane, feature).touched;
  const std::vector<Target>& meant = state(nominal, feature).meant;
  const Rigid X_DW = inverse(lane.X_WD), X_DW_nominal = inverse(nominal.X_WD);
  std::vector<TouchedPoint> touches;
  touches.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    touches.push_back({X_DW * points[k], X_DW_nominal * meant[k].point, X_DW_nominal.R * meant[k].normal});
  }
  return touches;
}

std::vector<Vec3> BlockRun::faces_of(Lane& lane, plan::FeatureId feature) {
  const FeatureKind& kind = *executor.plan_[feature].kind;
  const FeatureState& of = state(lane, feature);
  std::vector<Vec3> faces = kind.acts_as == Shape::plane && kind.shape != Shape::plane ? of.touched : of.faces;
  for (Vec3& p : faces) p = inverse(lane.X_WD) * p;
  return faces;
}

std::optional<ToleranceLimits> BlockRun::widened(int i, const plan::CharacteristicDef& def, ToleranceLimits limits) {
  const plan::Plan& plan = executor.plan_;
  Lane& lane = block.lanes[i];
  for (const plan::MaterialCondition& m : def.widening) {
    const plan::ToleranceDef& size = plan[m.size];
    const Element* element = actual(i, m.feature);
    if (!element) return std::nullopt;
    const Element own = inverse(lane.X_WD) * *element, nominal = nominal_of(lane, m.feature);
    const Shape shape = plan[m.feature].kind->acts_as;
    const Arguments arguments = filled(lane, size.arguments, size.varying);
    const Outcome<double> value = size.kind->evaluate(arguments, {{&shape, 1}, {&own, 1}, {&nominal, 1}, {}, {}, {}});
    if (!value) return trap(i, value.failure), std::nullopt;
    limits.upper = limits.upper.value_or(0) +
        departure_mm(*size.kind, value.value, size.kind->limits(arguments, {&nominal, 1}), plan[m.feature].inner,
                     m.condition);
  }
  return limits;
}

void BlockRun::operator()(const plan::Evaluate& evaluate) {
  const plan::Plan& plan = executor.plan_;
  const plan::CharacteristicDef& def = plan[evaluate.characteristic];
  const plan::ToleranceDef& tolerance = plan[def.tolerance];
  std::vector<plan::FeatureId> features = def.features;
  for (const int id : tolerance.arguments.features("reference")) features.push_back({id});
  std::vector<plan::FeatureId> datums;
  for (const int id : tolerance.arguments.features("datum")) datums.push_back({id});

  std::vector<Shape> shapes, datum_shapes;
  for (const auto id : features) shapes.push_back(plan[id].kind->acts_as);
  for (const auto id : datums) datum_shapes.push_back(plan[id].kind->acts_as);
  std::vector<Element> actuals(features.size()), nominals(features.size()), datum_actuals(datums.size()),
      nominal_datums(datums.size());

  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    Lane& nominal = nominal_lane_of(lane);
    const Rigid X_DW = inverse(lane.X_WD), X_DW_nominal = inverse(nominal.X_WD);
    for (std::size_t k = 0; k < features.size(); ++k) {
      const Element* element = actual(i, features[k]);
      if (!element) return "";
      actuals[k] = X_DW * *element;
      nominals[k] = nominal_of(lane, features[k]);
    }
    for (std::size_t k = 0; k < datums.size(); ++k) {
      const Element* element = actual(i, datums[k]);
      if (!element) return "";
      datum_actuals[k] = X_DW * *element;
      nominal_datums[k] = X_DW_nominal * state(nominal, datums[k]).actual;
    }
    std::vector<TouchedPoint> touches, second_touches;
    std::vector<Vec3> faces;
    if (needs_touches(*tolerance.kind, tolerance.arguments)) {
      touches = touches_of(lane, features.front());
      faces = faces_of(lane, features.front());
      if (features.size() > 1) second_touches = touches_of(lane, features[1]);
    }
    const Arguments arguments = filled(lane, tolerance.arguments, tolerance.varying);
    const Outcome<double> made = tolerance.kind->evaluate(
        arguments,
        {shapes, actuals, nominals, datum_shapes, datum_actuals, nominal_datums, touches, second_touches, faces});
    if (!made) return made.failure;
    const auto limits = widened(i, def, tolerance.kind->limits(arguments, nominals));
    if (!limits) return "";
    lane.values.push_back({evaluate.characteristic, visit(lane), made.value,
                           tolerance.kind->nominal(arguments, shapes, nominals), *limits});
    return "";
  });
}

void BlockRun::operator()(const plan::OutputFrame& output) {
  const Lane& lane = block.lanes[0];
  if (!observed || active.empty() || active.front() != 0 || !lane.running) return;
  const std::optional<Rigid>& X_WD = lane.frames[output.frame.value];
  if (!X_WD) return trap(0, "the coordinate system is not defined on this path");
  const Rigid X_WM{Mat3{}, executor.options_.placement_mm};
  observed->outputs.push_back({operation, {}, {}, inverse(X_WM) * *X_WD});
}

void BlockRun::operator()(const plan::Output& output) {
  const Lane& lane = block.lanes[0];
  if (!observed || active.empty() || active.front() != 0 || !lane.running) return;
  OutputRecord record{operation, {}, {}, {}};
  for (const plan::FeatureId feature : output.features) {
    const Element* element = actual(0, feature);
    if (!element) return;
    record.features.push_back(inverse(lane.X_WD) * *element);
  }
  for (const plan::CharacteristicId id : output.characteristics) {
    const auto latest =
        std::find_if(lane.values.rbegin(), lane.values.rend(), [&](const Value& v) { return v.characteristic == id; });
    if (latest != lane.values.rend()) record.values.push_back({id, latest->value, latest->limits});
  }
  observed->outputs.push_back(std::move(record));
}

}  // namespace abbe
