// STUDY.toml: rungs of a ladder of scenes, how their results differ from a reference, and what is good enough.
// Read by the same declarations as a scene; `spindrift study` (src/app) checks what expand() names, src/report/spindrift_study.py
// runs and judges it. Tested in tests/src/scene/study_test.cpp; explained in docs/user/studies.md. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/scene/document.hpp"
#include "src/scene/section.hpp"

namespace spindrift::scene {

/// Which points of the axes are run.
enum class Design {
  product,        ///< all of the product of all axes
  one_at_a_time,  ///< the pivot (the first point of each axis) and each axis by itself
  pairs           ///< that, then the points where the axes that matter most are both off the pivot
};

/// [study]
struct StudyOptions {
  std::string scene;             ///< scene file of the variants that name none
  std::vector<std::string> set;  ///< overrides of every run, "time.end_s=60"
  Design design = Design::product;
  int crossed = 2;  ///< pairs: so many of the axes that matter most
  int threads = 1;  ///< of each run
  std::optional<int> at_once = {};
  std::optional<double> budget_core_h = {};
  double confidence = 0.95;
  int repeats = 3;
};

/// [variants.NAME]: a rung of the ladder: a scene of its own or a named set of overrides.
struct VariantOptions {
  std::string scene = {};  ///< empty: that of [study]
  std::vector<std::string> set = {};
  bool alone = false;                ///< not multiplied with the axes
  std::optional<int> replicas = {};  ///< at most so many of them; 0: one run that they do not touch
  double safety_factor = 1.35;       ///< of extremes in a table of load cases
  bool fatigue = true;               ///< its runs do damage in such a table
};

/// [[axes.NAME.points]]: overrides that change together.
struct PointOptions {
  std::string name;
  std::vector<std::string> set;
};

/// [axes.NAME], and [replicas].
struct AxisOptions {
  std::string key;                   ///< scene key that takes each of `values` ...
  std::vector<std::string> values;   ///< as TOML text
  std::vector<PointOptions> points;  ///< ... or several keys at once

  std::size_t size() const { return values.size() + points.size(); }
};

/// [reference]: what errors are measured against.
struct ReferenceOptions {
  std::string variant;  ///< name of a run, or
  std::string history;  ///< a history.csv from elsewhere, with the same columns, or
  std::string limit;    ///< name of an axis: Richardson's limit along it
};

/// How the difference from the reference becomes one number.
enum class Measure { rms, max, mean, last, deviation, peak, amplitude, phase, period, damping, damage };

/// [metrics.NAME]: an error, from one history column.
struct MetricOptions {
  std::string column;
  Measure measure = Measure::rms;
  double from_s = 0.0;
  std::optional<double> until_s = {};       ///< the end where absent
  std::optional<double> frequency_Hz = {};  ///< of amplitude and phase
  double wohler_exponent = 4.0;             ///< of damage
  bool relative = false;                    ///< divided by the reference's value
  double divide_by = 1.0;                   ///< in the column's unit: makes errors of different columns comparable
  std::optional<double> target = {};        ///< largest error that is good enough
};

/// [load_cases]: statistics, design extremes and damage of the runs.
struct LoadCasesOptions {
  std::vector<std::string> columns;
  double from_s = 0.0;
  std::string wind_axis;                             ///< whose values are wind speeds; empty: no life
  double mean_wind_m_s = 10.0, weibull_shape = 2.0;  ///< class I of IEC 61400-1
  double years = 20.0, equivalent_cycles = 1e7;
  std::vector<double> wohler_exponents = {4.0, 10.0};
};

struct Study {
  std::string file;       ///< as given
  std::string directory;  ///< overrides that name files start here
  StudyOptions study;
  std::vector<Named<VariantOptions>> variants;
  std::vector<Named<AxisOptions>> axes;
  std::optional<AxisOptions> replicas;
  std::optional<ReferenceOptions> reference;
  std::vector<Named<MetricOptions>> metrics;
  std::optional<LoadCasesOptions> load_cases;
};

/// One rung of a study, to be run once per replica.
struct StudyRun {
  std::string name;                    ///< "morison-step_0.05": also its directory
  std::string scene = {};              ///< the file
  std::vector<std::string> overrides;  ///< for scene::load, in order: of the study, the variant, the axes
  std::string variant = {};            ///< of which variant
  std::vector<int> at = {};            ///< point of each axis; empty of a variant that is alone
  bool later = false;                  ///< pairs: run where its two axes turn out to matter
  int replicas = 1;                    ///< how many; 0: one run that they do not touch
  double safety_factor = 1.35;         ///< as of its variant
  bool fatigue = true;
};

/// A point of an axis, or a replica: its name ("step_0.1") and what it sets.
struct StudyPoint {
  std::string name;
  std::vector<std::string> set;
};
std::vector<StudyPoint> points_of(const std::string& axis, const AxisOptions& options);

/// Reads and checks a study file: throws SceneError with all its problems. The scenes themselves are read per run.
Study read_study(const std::string& path, const std::vector<std::string>& overrides = {});

/// All rungs: each variant (one called "base" where there is none) at the points of the axes that the design takes, the last axis
/// fastest; in file order.
std::vector<StudyRun> expand(const Study& study);

std::string_view name(Design design);
std::string_view name(Measure measure);

/// The declarations, for the reference.
std::vector<const SectionBase*> study_sections();

}  // namespace spindrift::scene
