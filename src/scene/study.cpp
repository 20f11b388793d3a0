// SPDX-License-Identifier: Apache-2.0
#include "src/scene/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "src/scene/layers.hpp"

namespace spindrift::scene {

namespace {

constexpr std::size_t most_runs = 10000;  // more is a slip of the hand

const Section<StudyOptions>& study_section() {
  static const auto section = Section<StudyOptions>("study", "Variants of one scene, compared by error and cost.")
                                  .path("scene", &StudyOptions::scene, "Scene file that all variants start from.")
                                  .required()
                                  .texts("set", &StudyOptions::set, "Overrides of every variant, each KEY=VALUE.");
  return section;
}

const Section<VariantOptions>& variant_section() {
  static const auto section = Section<VariantOptions>("variants", "A named set of overrides.")
                                  .named()
                                  .texts("set", &VariantOptions::set, "Overrides of this variant, each KEY=VALUE.")
                                  .flag("alone", &VariantOptions::alone, "Runs once, not at every point of the axes.");
  return section;
}

const Section<PointOptions>& point_section() {
  static const auto section = Section<PointOptions>("points", "Overrides that change together.")
                                  .text("name", &PointOptions::name, "What the point is called in names of runs.")
                                  .required()
                                  .texts("set", &PointOptions::set, "Overrides at this point, each KEY=VALUE.")
                                  .required();
  return section;
}

const Section<AxisOptions>& axis_section() {
  static const auto section =
      Section<AxisOptions>("axes", "A direction of variation: every variant runs at every point of the product of all axes.")
          .named()
          .text("key", &AxisOptions::key, "Scene key that takes each of the values.")
          .values("values", &AxisOptions::values, "Values of the key.")
          .size(1)
          .tables("points", &AxisOptions::points, point_section(),
                  "Points where several keys change together, instead of key and values.")
          .one_of({"key", "points"})
          .one_of({"values", "points"});
  return section;
}

const Section<ReferenceOptions>& reference_section() {
  static const auto section = Section<ReferenceOptions>("reference", "What errors are measured against.")
                                  .text("variant", &ReferenceOptions::variant, "Name of a run of this study.")
                                  .path("history", &ReferenceOptions::history,
                                        "A history.csv from elsewhere that has time_s and the columns of the metrics.")
                                  .one_of({"variant", "history"});
  return section;
}

const Section<MetricOptions>& metric_section() {
  static const auto section =
      Section<MetricOptions>("metrics", "An error: the difference of a history column from the reference's.")
          .named()
          .text("column", &MetricOptions::column, "Column of history.csv.")
          .required()
          .choice("measure", &MetricOptions::measure,
                  {{"rms", Measure::rms, "root of the mean square of the difference"},
                   {"max", Measure::max, "largest absolute difference"},
                   {"mean", Measure::mean, "absolute difference of the means"},
                   {"last", Measure::last, "absolute difference at the end"}},
                  "How the difference becomes one number.")
          .number("from_s", &MetricOptions::from_s, "s", "Start of the time range.")
          .number("until_s", &MetricOptions::until_s, "s", "End of the time range; that of the shorter history where absent.")
          .number("divide_by", &MetricOptions::divide_by, "-",
                  "Divides the error, in the column's unit: makes columns comparable.", positive())
          .number("target", &MetricOptions::target, "-", "Largest error that is good enough, after the division.", positive())
          .check([](const MetricOptions& o, const Report& report) {
            if (o.until_s && *o.until_s <= o.from_s) report("until_s", "must be later than from_s");
          });
  return section;
}

/// Overrides are checked for their form here; their keys when the scene is read.
void check_form(Document& doc, const std::string& key, const std::vector<std::string>& set) {
  for (std::size_t i = 0; i < set.size(); ++i) {
    const std::size_t equals = set[i].find('=');
    if (equals == std::string::npos || !parse_key(set[i].substr(0, set[i].find_last_not_of(' ', equals - 1) + 1)))
      doc.problem(fmt::format("{}[{}]", key, i), "is no override; write SECTION.KEY=VALUE");
  }
}

void check_axes(Document& doc, const std::vector<Named<AxisOptions>>& axes) {
  for (const auto& [name, axis] : axes) {
    if (!axis.key.empty() && !parse_key(axis.key)) doc.problem("axes." + name + ".key", "is no key of a scene");
    if (axis.key.empty() && axis.points.empty() && doc.given("axes." + name + ".points"))
      doc.problem("axes." + name + ".points", "must have at least one entry");
    for (std::size_t i = 0; i < axis.points.size(); ++i)
      check_form(doc, fmt::format("axes.{}.points[{}].set", name, i), axis.points[i].set);
  }
}

/// Fit for a directory: 'sea.table="a b.csv"' gives a_b.csv.
std::string short_name(std::string text) {
  std::erase(text, '"');
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_' && c != '-' && c != '+') c = '_';
  return text;
}

/// The points of one axis, whichever way they were given.
std::vector<StudyRun> points_of(const Named<AxisOptions>& axis) {
  std::vector<StudyRun> points;
  for (const std::string& value : axis.options.values)
    points.push_back({axis.name + "_" + short_name(value), {axis.options.key + "=" + value}});
  for (const PointOptions& point : axis.options.points) points.push_back({axis.name + "_" + short_name(point.name), point.set});
  return points;
}

void append(std::vector<std::string>& to, const std::vector<std::string>& more) { to.insert(to.end(), more.begin(), more.end()); }

std::size_t size_of_product(const Study& study) {
  double size = double(std::max<std::size_t>(1, study.variants.size()));
  for (const auto& axis : study.axes) size *= double(axis.options.values.size() + axis.options.points.size());
  return std::size_t(std::min(size, 1e18));
}

/// Two runs of one name would share a directory; a reference must be one of the runs.
void check_runs(Document& doc, const Study& study) {
  if (size_of_product(study) > most_runs)
    return doc.problem("axes", fmt::format("give {} runs; at most {}", size_of_product(study), most_runs));
  std::set<std::string> names;
  std::vector<std::string> all;
  for (const StudyRun& run : expand(study)) {
    if (!names.insert(run.name).second) doc.problem("variants", fmt::format("two runs would be called '{}'", run.name));
    all.push_back(run.name);
  }
  if (!study.reference || study.reference->variant.empty() || names.count(study.reference->variant)) return;
  const std::string near = nearest(study.reference->variant, all);
  constexpr std::size_t few = 12;
  if (all.size() > few) all.resize(few), all.push_back("...");
  doc.problem("reference.variant",
              "is no run of this study; " + (near.empty() ? "there are: " + joined(all, ", ") : "did you mean '" + near + "'?"));
}

}  // namespace

std::vector<const SectionBase*> study_sections() {
  return {&study_section(), &variant_section(), &axis_section(), &reference_section(), &metric_section()};
}

Study read_study(const std::string& path, const std::vector<std::string>& overrides) {
  Document doc = load(path, overrides);
  Study study;
  study.file = doc.source();
  study.directory = doc.directory();
  study.study = doc.read(study_section());
  study.variants = doc.read_named(variant_section());
  study.axes = doc.read_named(axis_section());
  study.reference = doc.read_if_given(reference_section());
  study.metrics = doc.read_named(metric_section());
  check_form(doc, "study.set", study.study.set);
  for (const auto& [name, variant] : study.variants) check_form(doc, "variants." + name + ".set", variant.set);
  check_axes(doc, study.axes);
  if (!study.metrics.empty() && !study.reference) doc.problem("metrics", "need a [reference] to measure against");
  check_runs(doc, study);
  doc.finish();
  return study;
}

std::vector<StudyRun> expand(const Study& study) {
  std::vector<StudyRun> product = {{"", {}}};
  for (const auto& axis : study.axes) {
    std::vector<StudyRun> next;
    for (const StudyRun& so_far : product)
      for (const StudyRun& point : points_of(axis)) {
        StudyRun run = so_far;
        run.name += "-" + point.name;
        append(run.overrides, point.overrides);
        next.push_back(std::move(run));
      }
    product = std::move(next);
  }
  std::vector<Named<VariantOptions>> variants = study.variants;
  if (variants.empty()) variants.push_back({"base", {}});
  std::vector<StudyRun> runs;
  for (const auto& [name, variant] : variants)
    for (const StudyRun& at : variant.alone ? std::vector<StudyRun>{{"", {}}} : product) {
      StudyRun run{name + at.name, study.study.set};
      append(run.overrides, variant.set);
      append(run.overrides, at.overrides);
      runs.push_back(std::move(run));
    }
  return runs;
}

}  // namespace spindrift::scene
