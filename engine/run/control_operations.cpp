// Handlers of variables and control flow.
#include <algorithm>
#include <cmath>

#include "engine/features/displacement.hpp"
#include "engine/features/shape_traits.hpp"
#include "engine/run/block_run.hpp"

namespace abbe {

Outcome<double> BlockRun::evaluate(const Lane& lane, const plan::Expression& expression) const {
  return plan::evaluate(expression, [&](plan::ColumnId id) { return lane.columns[id.value]; });
}

Arguments BlockRun::filled(const Lane& lane, const Arguments& arguments,
                           const std::vector<plan::VaryingNumber>& varying) const {
  Arguments all = arguments;
  for (const plan::VaryingNumber& v : varying) all.set_number(v.name, v.index, lane.columns[v.column.value]);
  return all;
}

namespace {

/// The vector whose first component the quantity is.
Vec3 vector_of(const Element& e, plan::Quantity first) {
  using enum plan::Quantity;
  const auto from_centre_to_focus = [&] {
    return std::sqrt(std::max(0.0, e.size * e.size - e.minor_size * e.minor_size)) * e.second;
  };
  switch (first) {
    case x: return e.point;
    case i: return e.direction;
    case begin_x: return e.point + e.begin * e.direction;
    case end_x: return e.point + e.end * e.direction;
    case second_i: return e.second;
    case third_i: return cross(e.direction, e.second);
    case apex_x: return apex(e);
    case focus1_x: return e.point - from_centre_to_focus();
    case focus2_x: return e.point + from_centre_to_focus();
    case face1_x: return e.point + e.size * e.direction;
    case face2_x: return e.point - e.size * e.direction;
    default: ABBE_CHECK(false);
  }
}

double quantity_of(const Element& e, plan::Quantity quantity) {
  using enum plan::Quantity;
  switch (quantity) {
    case radius: return e.size;
    case minor_radius: return e.minor_size;
    case angle: return e.angle;
    case length: return e.end - e.begin;
    case form: return e.high - e.low;
    default: break;
  }
  const int component = static_cast<int>(quantity) % 3;  // vectors come first, three quantities each
  return vector_of(e, static_cast<plan::Quantity>(static_cast<int>(quantity) - component))[component];
}

}  // namespace

void BlockRun::operator()(const plan::Obtain& obtain) {
  for_active([&](int i) -> std::string {
    const Element* element = actual(i, obtain.feature);
    if (!element) return "";
    Lane& lane = block.lanes[i];
    lane.columns[obtain.column.value] = quantity_of(inverse(lane.X_WD) * *element, obtain.quantity);
    return "";
  });
}

void BlockRun::operator()(const plan::ObtainDisplacement& obtain) {
  for_active([&](int i) -> std::string {
    const Element* element = actual(i, obtain.feature);
    if (!element) return "";
    Lane& lane = block.lanes[i];
    const Shape shape = executor.plan_[obtain.feature].kind->shape;
    const Vec3 by = transpose(lane.X_WD.R) * displacement(shape, *element, programmed(lane, obtain.feature));
    for (int k = 0; k < 3; ++k) lane.columns[obtain.first.value + k] = by[k];
    return "";
  });
}

void BlockRun::operator()(const plan::ObtainEvaluation& obtain) {
  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    const auto latest = std::find_if(lane.values.rbegin(), lane.values.rend(), [&](const Value& v) {
      return std::find(obtain.characteristics.begin(), obtain.characteristics.end(), v.characteristic) !=
          obtain.characteristics.end();
    });
    if (latest == lane.values.rend())
      return "a tolerance is obtained that was not evaluated on the path that was taken";
    const ToleranceLimits& limits = latest->limits;
    const bool inside =
        !(limits.lower && latest->value < *limits.lower) && !(limits.upper && latest->value > *limits.upper);
    lane.columns[obtain.column.value] = obtain.status ? (inside ? 1 : 0) : latest->value;
    return "";
  });
}

void BlockRun::operator()(const plan::Assign& assign) {
  for_active([&](int i) -> std::string {
    Lane& lane = block.lanes[i];
    const Outcome<double> v = evaluate(lane, assign.value);
    if (!v) return v.failure;
    int offset = 0;
    if (!assign.index.empty()) {
      const Outcome<double> index = evaluate(lane, assign.index);
      if (!index) return index.failure;
      offset = plan::element_offset(index.value, assign.count);
      if (offset < 0) return plan::kOutsideArray;
    }
    lane.columns[assign.column.value + offset * assign.stride] = v.value;
    return "";
  });
}

void BlockRun::operator()(const plan::Jump& jump) {
  for (const int i : active) block.lanes[i].pc = jump.target;
}

void BlockRun::operator()(const plan::JumpUnless& jump) {
  Outcomes condition(block.lanes.size(), 0);
  for_active([&](int i) -> std::string {
    const Outcome<double> v = evaluate(block.lanes[i], jump.condition);
    if (!v) return v.failure;
    condition[i] = v.value != 0;
    return "";
  });
  part_twins(condition);
  for (const int i : active)
    if (block.lanes[i].running && !condition[i]) block.lanes[i].pc = jump.target;
}

void BlockRun::part_twins(Outcomes& condition) {
  const std::vector<int> before = active;
  for (const int t : before) {
    if (!block.is_twin(t) || !block.lanes[t].running) continue;
    if (block.is_nominal(t) && !block.part_is_nominal()) continue;  // goes where its twin goes
    const int nominal = block.lanes[t].nominal;
    std::vector<int> going[2];
    for (const int i : before)
      if (!block.is_twin(i) && block.lanes[i].running && block.lanes[i].twin == t)
        going[condition[i] != 0].push_back(i);
    // The reference decides by itself; any other twin exists only for its machines and goes where they go.
    if (t != block.reference()) {
      if (going[0].empty() && going[1].empty()) {
        block.lanes[t].running = block.lanes[nominal].running = false;
        continue;
      }
      condition[t] = going[0].empty();
    }
    condition[nominal] = condition[t];
    const std::vector<int>& parting = going[condition[t] == 0];
    if (parting.empty()) continue;
    const bool other_way = condition[t] == 0;
    const int clone = clone_twin(t);
    for (const int i : parting) block.lanes[i].twin = clone;
    for (int i = clone; i < static_cast<int>(block.lanes.size()); ++i) {
      condition.push_back(other_way);
      active.push_back(i);
    }
  }
}

int BlockRun::clone_twin(int t) {
  const int clone = static_cast<int>(block.lanes.size()), nominal = block.lanes[t].nominal;
  block.lanes.push_back(Lane(block.lanes[t]));
  if (nominal != t) block.lanes.push_back(Lane(block.lanes[nominal]));
  const int last = static_cast<int>(block.lanes.size()) - 1;
  for (int i = clone; i <= last; ++i) block.lanes[i].twin = i, block.lanes[i].nominal = last;
  return clone;
}

}  // namespace abbe
