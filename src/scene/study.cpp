// SPDX-License-Identifier: Apache-2.0
#include "src/scene/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <set>

#include "src/scene/layers.hpp"

namespace spindrift::scene {

namespace {

constexpr std::size_t most_runs = 10000;  // more is a slip of the hand

struct DesignWord {
  Design design;
  const char *word, *help;
};
constexpr std::array designs{
    DesignWord{Design::product, "product", "every variant at every point of the product of all axes"},
    DesignWord{Design::one_at_a_time, "one_at_a_time", "the first point of each axis (the pivot), then each axis by itself"},
    DesignWord{Design::pairs, "pairs", "that, then the points where the axes that matter most both leave the pivot"}};

struct MeasureWord {
  Measure measure;
  const char *word, *help;
};
constexpr std::array measures{
    MeasureWord{Measure::rms, "rms", "root of the mean square of the difference of the two histories"},
    MeasureWord{Measure::max, "max", "largest absolute difference of the two histories"},
    MeasureWord{Measure::mean, "mean", "difference of the means"},
    MeasureWord{Measure::last, "last", "difference at the end"},
    MeasureWord{Measure::deviation, "deviation", "difference of the standard deviations"},
    MeasureWord{Measure::peak, "peak", "difference of the largest absolute values"},
    MeasureWord{Measure::amplitude, "amplitude", "difference of the amplitudes at frequency_Hz, by least squares"},
    MeasureWord{Measure::phase, "phase", "difference of the phases at frequency_Hz [deg]"},
    MeasureWord{Measure::period, "period",
                "difference of the mean periods, of a decay between its extremes, else between upward crossings of the mean [s]"},
    MeasureWord{Measure::damping, "damping", "difference of the damping ratios by the decrement of successive extremes"},
    MeasureWord{Measure::damage, "damage",
                "difference of the damage-equivalent ranges at 1 Hz: rainflow count after ASTM E1049, exponent wohler_exponent"}};

const Section<StudyOptions>& study_section() {
  static const auto section = [] {
    std::vector<Section<StudyOptions>::Case<Design>> words;
    for (const DesignWord& d : designs) words.push_back({d.word, d.design, d.help});
    return Section<StudyOptions>("study", "Variants of one scene, or scenes, compared by error and cost.")
        .path("scene", &StudyOptions::scene, "Scene file of the variants that name none.")
        .texts("set", &StudyOptions::set, "Overrides of every run, each KEY=VALUE.")
        .choice("design", &StudyOptions::design, words, "Which points of the axes are run.")
        .integer("crossed", &StudyOptions::crossed, "-", "So many of the axes that matter most are crossed.", between(2, 6))
        .only_if("design", {"pairs"})
        .integer("threads", &StudyOptions::threads, "-", "Threads of each run.", at_least(1))
        .integer("at_once", &StudyOptions::at_once, "-", "Runs at the same time; as many as cores are free where absent.",
                 at_least(1))
        .number("budget_core_h", &StudyOptions::budget_core_h, "h",
                "Core-hours that all runs may take, those done before among them: what the forecast puts beyond is left out, "
                "dearest first.",
                positive())
        .number("confidence", &StudyOptions::confidence, "-", "Of the intervals, and at least of the result.",
                between(0.5, 0.999))
        .integer("repeats", &StudyOptions::repeats, "-",
                 "Runs that compete for the result are timed so often; the least time counts.", between(1, 20));
  }();
  return section;
}

const Section<VariantOptions>& variant_section() {
  static const auto section =
      Section<VariantOptions>("variants",
                              "A variant: a scene, or a named set of overrides. At each point of the axes it is a configuration.")
          .named()
          .path("scene", &VariantOptions::scene, "Scene file of this variant; that of [study] where absent.")
          .texts("set", &VariantOptions::set, "Overrides of this variant, each KEY=VALUE.")
          .flag("alone", &VariantOptions::alone, "Not taken to the points of the axes.")
          .integer("replicas", &VariantOptions::replicas, "-",
                   "At most so many replicas; all where absent. 0: nothing in this variant depends on them; "
                   "it runs once, as the scene is, and "
                   "stands beside each replica of the others.",
                   at_least(0))
          .number("safety_factor", &VariantOptions::safety_factor, "-",
                  "Partial factor of its extremes in [load_cases]: 1.35 of normal, 1.1 of abnormal, 1.5 "
                  "of transport and maintenance cases (IEC 61400-1).",
                  between(1.0, 3.0))
          .flag("fatigue", &VariantOptions::fatigue, "Its runs do damage in [load_cases].");
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

Section<AxisOptions> with_points(Section<AxisOptions> section) {
  return section.text("key", &AxisOptions::key, "Scene key that takes each of the values.")
      .values("values", &AxisOptions::values, "Values of the key.")
      .size(1)
      .tables("points", &AxisOptions::points, point_section(),
              "Points where several keys change together, instead of key and values.")
      .one_of({"key", "points"})
      .one_of({"values", "points"});
}

const Section<AxisOptions>& axis_section() {
  static const auto section = with_points(
      Section<AxisOptions>("axes", "A direction of variation; its first point is the pivot of the designs that have one.")
          .named());
  return section;
}

const Section<AxisOptions>& replicas_section() {
  static const auto section =
      with_points(Section<AxisOptions>("replicas",
                                       "Every configuration is run at each of these, which differ by chance alone (seed, phase "
                                       "of the waves, sea.particles.jitter_seed): "
                                       "errors are paired between configurations, their scatter is the noise floor."));
  return section;
}

const Section<ReferenceOptions>& reference_section() {
  static const auto section =
      Section<ReferenceOptions>("reference", "What errors are measured against.")
          .text("variant", &ReferenceOptions::variant, "Name of a configuration of this study.")
          .path("history", &ReferenceOptions::history,
                "A history.csv from elsewhere that has time_s and the columns of the metrics, and covers 95 % of the time that "
                "each metric takes.")
          .text("limit", &ReferenceOptions::limit,
                "Name of an axis whose values are numbers: Richardson's limit from its three finest, with "
                "the order that they show.")
          .one_of({"variant", "history", "limit"});
  return section;
}

const Section<LoadCasesOptions>& load_cases_section() {
  static const auto section =
      Section<LoadCasesOptions>(
          "load_cases",
          "A table of design load cases: statistics of every configuration over its replicas, design extremes, and "
          "damage-equivalent ranges of a life.")
          .texts("columns", &LoadCasesOptions::columns, "Columns of history.csv.")
          .required()
          .number("from_s", &LoadCasesOptions::from_s, "s", "Start of the time range: what comes before is start-up.")
          .text("wind_axis", &LoadCasesOptions::wind_axis,
                "Name of the axis whose values are mean wind speeds; where not given there are extremes, but no life.")
          .number("mean_wind_m_s", &LoadCasesOptions::mean_wind_m_s, "m/s",
                  "Mean wind of the site at the hub: 10, 8.5, 7.5 of classes I, II, III (IEC 61400-1).", positive())
          .number("weibull_shape", &LoadCasesOptions::weibull_shape, "-", "Of the distribution of wind speeds; 2 is Rayleigh's.",
                  between(1.0, 4.0))
          .number("years", &LoadCasesOptions::years, "-", "Length of the life [years].", positive())
          .number("equivalent_cycles", &LoadCasesOptions::equivalent_cycles, "-", "Cycles of the equivalent range in the life.",
                  positive())
          .numbers("wohler_exponents", &LoadCasesOptions::wohler_exponents, "-",
                   "Slopes of S-N curves: 3 to 4 of steel, 10 of glass fibre.", between(1.0, 20.0));
  return section;
}

bool of_two_histories(Measure m) { return m == Measure::rms || m == Measure::max; }

const Section<MetricOptions>& metric_section() {
  static const auto section = [] {
    std::vector<Section<MetricOptions>::Case<Measure>> words;
    for (const MeasureWord& m : measures) words.push_back({m.word, m.measure, m.help});
    return Section<MetricOptions>(
               "metrics",
               "A number from a history column, and how it differs from the reference's; without a reference the number alone.")
        .named()
        .text("column", &MetricOptions::column, "Column of history.csv.")
        .required()
        .choice("measure", &MetricOptions::measure, words, "How the difference becomes one number.")
        .number("from_s", &MetricOptions::from_s, "s", "Start of the time range.")
        .number("until_s", &MetricOptions::until_s, "s", "End of the time range; that of the shorter history where absent.")
        .number("frequency_Hz", &MetricOptions::frequency_Hz, "Hz", "Frequency looked at.", positive())
        .required()
        .only_if("measure", {"amplitude", "phase"})
        .number("wohler_exponent", &MetricOptions::wohler_exponent, "-",
                "Slope of the S-N curve: 3 to 4 of steel, 10 of glass fibre.", between(1.0, 20.0))
        .only_if("measure", {"damage"})
        .flag("relative", &MetricOptions::relative, "The error is divided by the reference's own value.")
        .number("divide_by", &MetricOptions::divide_by, "-", "Divides the error, in the column's unit: makes columns comparable.",
                positive())
        .number("target", &MetricOptions::target, "-", "Largest error that is good enough, after the division.", positive())
        .at_most_one_of({"relative", "divide_by"})
        .check([](const MetricOptions& o, const Report& report) {
          if (o.until_s && *o.until_s <= o.from_s) report("until_s", "must be later than from_s");
          if (o.relative && of_two_histories(o.measure))
            report("relative", "has no effect: rms and max compare histories; use divide_by");
        });
  }();
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

void check_points(Document& doc, const std::string& at, const AxisOptions& axis) {
  if (!axis.key.empty() && !parse_key(axis.key)) doc.problem(at + ".key", "is no key of a scene");
  if (axis.key.empty() && axis.points.empty() && doc.given(at + ".points"))
    doc.problem(at + ".points", "must have at least one entry");
  for (std::size_t i = 0; i < axis.points.size(); ++i)
    check_form(doc, fmt::format("{}.points[{}].set", at, i), axis.points[i].set);
}

/// Keys that the points of an axis set, each as it is written there and in its parts; what is no key is told elsewhere.
std::vector<std::pair<std::string, std::vector<std::string>>> keys_of(const AxisOptions& axis) {
  std::vector<std::string> texts{axis.key};
  for (const PointOptions& point : axis.points)
    for (const std::string& set : point.set) texts.push_back(set.substr(0, std::min(set.find('='), set.size())));
  std::vector<std::pair<std::string, std::vector<std::string>>> keys;
  for (std::string text : texts) {
    text.erase(text.find_last_not_of(' ') + 1);
    const auto steps = parse_key(text);
    if (!steps) continue;
    auto& parts = keys.emplace_back(text, std::vector<std::string>()).second;
    for (const KeyStep& step : *steps) {
      parts.push_back(step.name);
      for (const std::size_t index : step.indices) parts.push_back(std::to_string(index));
    }
  }
  return keys;
}

/// Of two axes that set one key, or a key within it, the second would win at every point.
void check_axes_apart(Document& doc, const Study& study) {
  std::vector<std::pair<std::string, const AxisOptions*>> all;
  for (const auto& [name, axis] : study.axes) all.emplace_back("axes." + name, &axis);
  if (study.replicas) all.emplace_back("replicas", &*study.replicas);
  const auto both = [](const AxisOptions& a, const AxisOptions& b) -> std::string {
    for (const auto& [key, parts] : keys_of(a))
      for (const auto& [other, others] : keys_of(b)) {
        const auto [here, there] = std::mismatch(parts.begin(), parts.end(), others.begin(), others.end());
        if (here == parts.end() || there == others.end()) return parts.size() >= others.size() ? key : other;
      }
    return "";
  };
  for (std::size_t b = 1; b < all.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      if (const std::string key = both(*all[a].second, *all[b].second); !key.empty())
        doc.problem(all[b].first + (all[b].second->key.empty() ? ".points" : ".key"),
                    fmt::format("sets {}, as {} does: a key is on one axis alone", key, all[a].first));
}

/// Fit for a directory: 'sea.table="a b.csv"' gives a_b.csv.
std::string short_name(std::string text) {
  std::erase(text, '"');
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_' && c != '-' && c != '+') c = '_';
  return text;
}

void append(std::vector<std::string>& to, const std::vector<std::string>& more) { to.insert(to.end(), more.begin(), more.end()); }

/// Runs of the whole product: an upper bound of every design.
std::size_t size_of_product(const Study& study) {
  double size = double(std::max<std::size_t>(1, study.variants.size()));
  for (const auto& axis : study.axes) size *= double(axis.options.size());
  return std::size_t(std::min(size, 1e18));
}

bool is_positive_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end == text.c_str() + text.size() && std::isfinite(value) && value > 0.0;
}

void check_load_cases(Document& doc, const Study& study) {
  const LoadCasesOptions& o = *study.load_cases;
  if (o.columns.empty()) doc.problem("load_cases.columns", "must name a column at least");
  if (o.wind_axis.empty()) return;
  const auto axis = std::find_if(study.axes.begin(), study.axes.end(), [&](const auto& a) { return a.name == o.wind_axis; });
  if (axis == study.axes.end()) return doc.problem("load_cases.wind_axis", "is no axis of this study");
  if (study.study.design != Design::product) doc.problem("study.design", "must be \"product\" for [load_cases] with a wind_axis");
  const std::vector<std::string>& values = axis->options.values;
  double before = 0.0;
  for (const std::string& value : values) {
    if (!is_positive_number(value) || std::stod(value) <= before)
      return doc.problem("load_cases.wind_axis",
                         "must have wind speeds > 0 as its values, from low to high: " + value + " is none");
    before = std::stod(value);
  }
  if (values.size() < 2) doc.problem("load_cases.wind_axis", "must have two values at least");
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
  if (!study.reference) return;
  if (const std::string& limit = study.reference->limit; !limit.empty()) {
    const auto axis = std::find_if(study.axes.begin(), study.axes.end(), [&](const auto& a) { return a.name == limit; });
    if (axis == study.axes.end()) return doc.problem("reference.limit", "is no axis of this study");
    if (axis->options.values.size() < 3) doc.problem("reference.limit", "needs at least three values of that axis");
    for (const std::string& value : axis->options.values)
      if (!is_positive_number(value)) doc.problem("reference.limit", "needs values > 0 on that axis: " + value + " is none");
    return;
  }
  if (study.reference->variant.empty() || names.count(study.reference->variant)) return;
  const std::string near = nearest(study.reference->variant, all);
  constexpr std::size_t few = 12;
  if (all.size() > few) all.resize(few), all.push_back("...");
  doc.problem("reference.variant",
              "is no run of this study; " + (near.empty() ? "there are: " + joined(all, ", ") : "did you mean '" + near + "'?"));
}

}  // namespace

std::vector<const SectionBase*> study_sections() {
  return {&study_section(),     &variant_section(), &axis_section(),      &replicas_section(),
          &reference_section(), &metric_section(),  &load_cases_section()};
}

Study read_study(const std::string& path, const std::vector<std::string>& overrides) {
  Document doc = load(path, overrides);
  Study study;
  study.file = doc.source();
  study.directory = doc.directory();
  study.study = doc.read(study_section());
  study.variants = doc.read_named(variant_section());
  study.axes = doc.read_named(axis_section());
  study.replicas = doc.read_if_given(replicas_section());
  study.reference = doc.read_if_given(reference_section());
  study.metrics = doc.read_named(metric_section());
  study.load_cases = doc.read_if_given(load_cases_section());
  check_form(doc, "study.set", study.study.set);
  for (const auto& [name, variant] : study.variants) {
    check_form(doc, "variants." + name + ".set", variant.set);
    if (variant.scene.empty() && study.study.scene.empty())
      doc.problem("variants." + name, "needs a scene: its own, or that of [study]");
  }
  if (study.variants.empty() && study.study.scene.empty()) doc.problem("study.scene", "is required where there are no variants");
  for (const auto& [name, axis] : study.axes) check_points(doc, "axes." + name, axis);
  if (study.replicas) check_points(doc, "replicas", *study.replicas);
  check_axes_apart(doc, study);
  if (!study.reference)  // a sweep: values alone
    for (const auto& [name, metric] : study.metrics) {
      const auto needs = [&, &name = name](const char* key) {
        doc.problem(fmt::format("metrics.{}.{}", name, key), "needs a [reference] to measure against");
      };
      if (of_two_histories(metric.measure))
        doc.problem(fmt::format("metrics.{}.measure", name),
                    "rms and max compare two histories and need a [reference]; mean and the others do not");
      if (metric.target) needs("target");
      if (metric.relative) needs("relative");
    }
  if (study.reference && !study.reference->limit.empty())
    for (const auto& [name, metric] : study.metrics)
      if (of_two_histories(metric.measure))
        doc.problem(fmt::format("metrics.{}.measure", name),
                    "rms and max compare two histories, and reference.limit is that of a number; take mean, peak, amplitude or "
                    "another one");
  if (study.load_cases) check_load_cases(doc, study);
  check_runs(doc, study);
  doc.finish();
  return study;
}

std::vector<StudyPoint> points_of(const std::string& axis, const AxisOptions& options) {
  std::vector<StudyPoint> points;
  for (const std::string& value : options.values) points.push_back({axis + "_" + short_name(value), {options.key + "=" + value}});
  for (const PointOptions& point : options.points) points.push_back({axis + "_" + short_name(point.name), point.set});
  return points;
}

std::vector<StudyRun> expand(const Study& study) {
  const bool whole = study.study.design == Design::product;
  std::vector<StudyRun> product = {{}};
  for (const auto& axis : study.axes) {
    const std::vector<StudyPoint> points = points_of(axis.name, axis.options);
    std::vector<StudyRun> next;
    for (const StudyRun& so_far : product)
      for (std::size_t p = 0; p < points.size(); ++p) {
        StudyRun run = so_far;
        if (whole || p > 0) run.name += "-" + points[p].name;
        append(run.overrides, points[p].set);
        run.at.push_back(int(p));
        next.push_back(std::move(run));
      }
    product = std::move(next);
  }
  std::erase_if(product, [&](StudyRun& run) {
    const auto off = std::count_if(run.at.begin(), run.at.end(), [](int p) { return p > 0; });
    run.later = !whole && off == 2;
    return !whole && off > (study.study.design == Design::pairs ? 2 : 1);
  });
  std::vector<Named<VariantOptions>> variants = study.variants;
  if (variants.empty()) variants.push_back({"base", {}});
  const int replicas = study.replicas ? int(study.replicas->size()) : 1;
  std::vector<StudyRun> runs;
  for (const auto& [name, variant] : variants)
    for (const StudyRun& at : variant.alone ? std::vector<StudyRun>{{}} : product) {
      StudyRun run = at;
      run.name = name + at.name, run.variant = name, run.overrides = study.study.set;
      run.scene = variant.scene.empty() ? study.study.scene : variant.scene;
      run.replicas = std::min(replicas, variant.replicas.value_or(replicas));
      run.safety_factor = variant.safety_factor, run.fatigue = variant.fatigue;
      append(run.overrides, variant.set);
      append(run.overrides, at.overrides);
      runs.push_back(std::move(run));
    }
  return runs;
}

std::string_view name(Design design) {
  return std::find_if(designs.begin(), designs.end(), [&](const DesignWord& d) { return d.design == design; })->word;
}

std::string_view name(Measure measure) {
  return std::find_if(measures.begin(), measures.end(), [&](const MeasureWord& m) { return m.measure == measure; })->word;
}

}  // namespace spindrift::scene
