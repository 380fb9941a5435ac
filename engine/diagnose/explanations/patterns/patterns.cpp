#include "engine/diagnose/explanations/patterns/patterns.hpp"

#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose {

namespace patterns {

void Family::append(std::string shape, const std::vector<Matrix>& variants, double share) {
  Explanation e;
  e.name = "OTHER " + std::string(name(factor_)) + ", " + shape;
  e.factor = factor_;
  e.shape = std::move(shape);
  e.share = factor_ == Factor::run ? kPriorChange * share : share;  // patterns over runs are made by a change alone
  for (const Matrix& columns : variants) {
    Variant variant;
    variant.explanation = static_cast<int>(out_.list.size());
    variant.signature = compressed(columns);
    variant.columns.assign(static_cast<std::size_t>(variant.signature.cols()), {});
    variant.joined = true;
    e.variants.push_back(static_cast<int>(out_.variants.size()));
    out_.variants.push_back(std::move(variant));
  }
  share_belief(e, out_.variants);
  out_.list.push_back(std::move(e));
}

void Family::add(std::string shape, const std::vector<Told>& variants) {
  std::vector<Matrix> columns;
  for (const Told& v : variants) columns.push_back(v.columns);
  append(std::move(shape), columns);
  const std::vector<int>& added = out_.list.back().variants;
  for (std::size_t k = 0; k < added.size(); ++k) out_.variants[added[k]].told = variants[k].what;
}

}  // namespace patterns

void add_pattern(Explanations& all, Factor factor, std::string shape, const Matrix& columns) {
  double prior = 0;
  for (const Explanation& e : all.list)
    if (!e.effect && e.share == 1) prior = e.prior;
  patterns::Family(factor, all).add(std::move(shape), columns);
  all.list.back().share = 1;
  all.list.back().prior = prior;
}

void add_other(const RecordedTouches& t, const std::vector<int>& rows, Explanations& out) {
  using namespace patterns;
  constexpr std::pair<Factor, void (*)(const TouchFactors&, Family&)> families[] = {
      {Factor::time, over_time},           {Factor::position, over_position},
      {Factor::direction, over_direction}, {Factor::head, over_head},
      {Factor::sensor, over_sensor},       {Factor::feature, over_feature},
      {Factor::setup, over_setup},         {Factor::run, over_run},
      {Factor::speed, over_speed},         {Factor::temperature, over_temperature}};
  const TouchFactors factors(t, rows);
  for (const auto& [factor, add] : families) {
    Family family(factor, out);
    add(factors, family);
  }
}

}  // namespace abbe::diagnose
