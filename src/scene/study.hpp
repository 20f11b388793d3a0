// STUDY.toml: variants of one scene, how their results differ from a reference, and what is good enough.
// Read by the same declarations as a scene; `spindrift study` (src/app) runs the variants that expand() names and
// judges them with src/scene/study_front.hpp. Tested in tests/src/scene/study_test.cpp; explained in docs/user/scenes.md.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/scene/document.hpp"
#include "src/scene/section.hpp"

namespace spindrift::scene {

/// [study]
struct StudyOptions {
  std::string scene;             ///< scene file that all variants start from
  std::vector<std::string> set;  ///< overrides of every variant, "time.end_s=60"
};

/// [variants.NAME]: a named set of overrides.
struct VariantOptions {
  std::vector<std::string> set;
  bool alone = false;  ///< not multiplied with the axes
};

/// [[axes.NAME.points]]: overrides that change together.
struct PointOptions {
  std::string name;
  std::vector<std::string> set;
};

/// [axes.NAME]: every variant runs at every point of it, and of the other axes.
struct AxisOptions {
  std::string key;                   ///< scene key that takes each of `values` ...
  std::vector<std::string> values;   ///< as TOML text
  std::vector<PointOptions> points;  ///< ... or several keys at once
};

/// [reference]: what errors are measured against.
struct ReferenceOptions {
  std::string variant;  ///< name of an expanded variant, or
  std::string history;  ///< a history.csv from elsewhere, with the same columns
};

enum class Measure { rms, max, mean, last };

/// [metrics.NAME]: an error, from the difference of one history column.
struct MetricOptions {
  std::string column;
  Measure measure = Measure::rms;
  double from_s = 0.0;
  std::optional<double> until_s = {};  ///< end of the shorter history where absent
  double divide_by = 1.0;              ///< in the column's unit: makes errors of different columns comparable
  std::optional<double> target = {};   ///< largest error that is good enough
};

struct Study {
  std::string file;       ///< as given
  std::string directory;  ///< overrides that name files start here
  StudyOptions study;
  std::vector<Named<VariantOptions>> variants;
  std::vector<Named<AxisOptions>> axes;
  std::optional<ReferenceOptions> reference;
  std::vector<Named<MetricOptions>> metrics;
};

/// One run of a study.
struct StudyRun {
  std::string name;                    ///< "morison-step_0.05": also its directory
  std::vector<std::string> overrides;  ///< for scene::load, in order: of the study, the variant, the axes
};

/// Reads and checks a study file: throws SceneError with all its problems. The scene itself is read per run.
Study read_study(const std::string& path, const std::vector<std::string>& overrides = {});

/// All runs: each variant (one called "base" where there is none) at each point of the product of the axes, the last axis
/// fastest; in file order.
std::vector<StudyRun> expand(const Study& study);

/// The declarations, for the reference.
std::vector<const SectionBase*> study_sections();

}  // namespace spindrift::scene
