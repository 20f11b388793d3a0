// The graph of one march of the air, top to bottom as the algorithm (docs/theory/air.md):
//   until converged: ghosts, gradients, residual, judgement, matrix; Krylov iterations; update.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/tasks.hpp"

#include <algorithm>
#include <utility>

#include "src/aero/flow/halo.hpp"
#include "src/aero/flow/sweep_gradients.hpp"

namespace spindrift::aero {

using namespace runtime;

namespace {

/// Of each owned tile, in the graph: its cells, and its ghosts.
struct HaloData {
  const std::vector<Datum>&inside, &ghosts;
};

/// Ghosts of centres and volumes, from tiles here and on other ranks.
void record_centres(Graph& graph, TileArrays& arrays, const TileMotion& motion, RecordedGraphs& recorded, const HaloData& of,
                    const std::vector<Use>& control) {
  const auto view = [&arrays](int t) -> TileGeometry& { return arrays.grid[t]; };
  const auto layout = [&arrays](const Tile& t) { return cell_layout(t, cell_ghosts, arrays.planar()); };
  const HaloField<double> centre{"aero/centres",
                                 [view](int t) { return view(t).centre(); },
                                 layout,
                                 {Quantity::point},
                                 cell_ghosts,
                                 &of.inside,
                                 &of.ghosts,
                                 6,
                                 &motion.periodic()};
  const HaloField<double> volume{"aero/volumes",
                                 [view](int t) { return view(t).volume(); },
                                 layout,
                                 {Quantity::scalar},
                                 cell_ghosts,
                                 &of.inside,
                                 &of.ghosts,
                                 7,
                                 &motion.periodic()};
  const auto always = [] { return true; };
  const auto nothing = [](int) {};
  record_halo<double>(graph, arrays.grid, arrays.local, centre, recorded.double_buffers, always, nothing, control);
  record_halo<double>(graph, arrays.grid, arrays.local, volume, recorded.double_buffers, always, nothing, control);
}

/// Names of what the tasks share, and the pieces of the graph.
class StepGraph {
 public:
  StepGraph(const MarchParts& parts, RecordedGraphs& recorded, Graph& graph)
      : arrays_(parts.arrays),
        time_(parts.time),
        motion_(parts.motion),
        residual_of_(parts.residual),
        system_(parts.system),
        judged_(parts.judgement),
        recorded_(recorded),
        g_(graph),
        owned_(arrays_.tiles.size()) {
    for (auto* data : {&state_, &state_ghosts_, &gradients_, &gradient_ghosts_, &residual_, &matrix_, &norms_, &vectors_,
                       &direction_, &direction_ghosts_, &size_, &trial_, &trial_ghosts_, &dots_, &fraction_, &past_, &gathered_})
      *data = graph.data(owned_);
    sums_ = graph.datum(), decision_ = graph.datum(), total_size_ = graph.datum(), total_dots_ = graph.datum(),
    krylov_ = graph.datum(), built_ = graph.datum(), common_ = graph.datum(), total_fraction_ = graph.datum();
    if (judged_.body_force()) samples_ = graph.data(owned_), sampled_ = graph.datum(), forces_ = graph.datum();
  }

  /// A common part is one thread's work: with one, all of the air is more urgent than the sea (1), so that it comes there while
  /// the others still have a sea to go on with. The round of one gives what stands outside the march's own loops that urgency
  /// too.
  void record() {
    if (common())
      g_.loop("aero/step", {.min = 1, .max = 1, .urgency = 2}, [&] { record_march(2); });
    else
      record_march(0);
  }

 private:
  void record_march(int urgency) {
    if (time_.unsteady()) begin_time_step();
    begin();
    if (motion_.moves()) move_grid();
    g_.loop("aero/pseudo", {.min = 1, .max = std::uint32_t(judged_.march().options().max_steps) + 2, .urgency = urgency}, [&] {
      residual_of_state();
      judge();
      each(
          "aero/matrix",
          [&](std::size_t n) {
            return Uses{reads(decision_),     reads(state_[n]),           reads(state_ghosts_[n]),
                        reads(gradients_[n]), reads(gradient_ghosts_[n]), writes(matrix_[n])};
          },
          [this](std::size_t n) {
            if (judged_.solving()) system_.build(tile(n), judged_.march().cfl(), judged_.refreshes());
          });
      if (common()) {
        Uses uses{reads(decision_), writes(built_)};
        uses.push_back(reads(matrix_));
        g_.collective(
            "aero/preconditioner", uses, [this](MPI_Comm comm) { system_.preconditioner().refresh_common(comm); },
            [this] { return judged_.refreshes(); });
      }
      g_.loop("aero/krylov", {.min = 1, .max = std::uint32_t(columns()), .urgency = urgency + 1}, [&] { krylov_iteration(); });
      update();
      g_.until("aero/converged", {reads(decision_)}, [this] { return ends_march(judged_.march().verdict()); });
    });
  }

  int columns() const { return system_.cycle().most_columns(); }
  bool common() const { return system_.preconditioner().has_common(); }
  std::string of(const char* path, std::size_t n) const {
    return std::string(path) + "/" + std::to_string(arrays_.tiles[n].index);
  }
  template <class UsesOf, class Work>
  void each(const char* path, UsesOf&& uses, Work work) {
    for (std::size_t n = 0; n < owned_; ++n) g_.task(of(path, n), uses(n), [work, n] { work(n); });
  }

  /// The past moves back by one step; ordered before all that reads the state.
  void begin_time_step() {
    each(
        "aero/past",
        [&](std::size_t n) {
          return Uses{reads(state_[n]), updates(past_[n])};
        },
        [this](std::size_t n) { residual_of_.keep_past(tile(n)); });
  }
  void begin() {
    Uses uses{updates(decision_)};
    uses.push_back(reads(past_));
    g_.task("aero/begin", uses, [this] {
      judged_.begin();
      system_.preconditioner().begin(time_.steps);
      if (!time_.unsteady()) return;
      time_.begin_step();
      residual_of_.begin_step();
      system_.set_physical_rate(time_.weights.now / time_.dt);
      motion_.begin_step();
    });
  }

  /// Nodes, metrics and face speeds of the new time level; what follows waits through the states.
  void move_grid() {
    each(
        "aero/move",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(past_[n]), updates(state_[n])};
        },
        [this](std::size_t n) { motion_.move(tile(n)); });
    record_centres(g_, arrays_, motion_, recorded_, {state_, state_ghosts_}, {reads(decision_)});
  }

  void residual_of_state() {
    ghosts_of("aero/ghosts", state_, state_ghosts_, false, 1);
    each(
        "aero/gradients",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(state_[n]), reads(state_ghosts_[n]), writes(gradients_[n])};
        },
        [this](std::size_t n) { residual_of_.gradients(tile(n), tile(n).state.data()); });
    gradient_ghosts(
        "aero/gradient_ghosts", [this] { return residual_of_.has_friction(); }, false, 2);
    if (judged_.body_force()) body_force();
    each(
        "aero/residual",
        [&](std::size_t n) {
          Uses uses{reads(state_[n]), reads(state_ghosts_[n]), reads(gradients_[n]), reads(gradient_ghosts_[n]),
                    reads(past_[n]),  reads(decision_),        writes(residual_[n]), writes(norms_[n])};
          if (judged_.body_force()) uses.push_back(reads(forces_));
          return uses;
        },
        [this](std::size_t n) {
          if (judged_.body_force()) judged_.body_force()->spread(n, tile(n));
          residual_of_.evaluate(tile(n), tile(n).state.data(), tile(n).residual.data());
          judged_.measure(n, system_, residual_of_);
        });
  }
  /// Forces inside the air, of the flow as it is: products of the linear solver see them as they stand.
  void body_force() {
    each(
        "aero/force/sample",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(state_[n]), writes(samples_[n])};
        },
        [this](std::size_t n) { judged_.body_force()->sample(n, tile(n), judged_.force_samples.of(n)); });
    TileSums& sums = judged_.force_samples;
    g_.reduce("aero/force/sums", {reads(samples_), reads(decision_), writes(sampled_)},
              {.partials = sums.partials, .result = sums.result});
    g_.task("aero/force/act", {reads(sampled_), reads(decision_), writes(forces_)},
            [this] { judged_.body_force()->act(judged_.force_samples.result); });
  }
  void judge() {
    g_.reduce("aero/norms", {reads(norms_), writes(sums_)}, {.partials = judged_.norms.partials, .result = judged_.norms.result});
    const Datum loads = g_.datum();
    g_.reduce("aero/loads", {reads(norms_), writes(loads)}, {.partials = judged_.loads.partials, .result = judged_.loads.result});
    g_.task("aero/judge", {reads(sums_), reads(loads), updates(decision_)}, [this] {
      judged_.judge();
      if (judged_.solving()) system_.begin(judged_.mean_norm(), judged_.model_norm(), judged_.refreshes());
    });
  }

  void krylov_iteration() {
    // v_j, and the direction z = M^-1 v_j.
    const auto vector_uses = [&](std::size_t n) {
      return Uses{reads(decision_), reads(krylov_), reads(residual_[n]), updates(vectors_[n])};
    };
    const auto direction_uses = [&](std::size_t n) {
      return Uses{reads(decision_), reads(matrix_[n]), updates(vectors_[n]), writes(direction_[n]), writes(size_[n])};
    };
    if (!common()) {
      for (std::size_t n = 0; n < owned_; ++n) {
        Uses uses = direction_uses(n);
        uses.push_back(reads(krylov_)), uses.push_back(reads(residual_[n]));
        g_.task(of("aero/krylov/direction", n), uses, [this, n](const Context& c) {
          vector(n, int(c.iteration));
          direction(n, int(c.iteration));
        });
      }
    } else {
      for (std::size_t n = 0; n < owned_; ++n) {
        Uses uses = vector_uses(n);
        uses.push_back(writes(gathered_[n])), uses.push_back(reads(built_));
        g_.task(of("aero/krylov/vector", n), uses, [this, n](const Context& c) {
          vector(n, int(c.iteration));
          if (judged_.solving()) system_.preconditioner().gather(tile(n), system_.cycle().source(tile(n), int(c.iteration)));
        });
      }
      common_part("aero/krylov/common");
      for (std::size_t n = 0; n < owned_; ++n) {
        Uses uses = direction_uses(n);
        uses.push_back(reads(common_));
        g_.task(of("aero/krylov/direction", n), uses, [this, n](const Context& c) { direction(n, int(c.iteration)); });
      }
    }
    g_.reduce("aero/krylov/size", {reads(size_), reads(decision_), writes(total_size_)},
              {Reduction::Operation::max, system_.direction_size.partials, system_.direction_size.result,
               [this] { return judged_.perturbs(); }});
    // w = A z: by the stored blocks, or by the residual of a state a little further along z.
    const HaloField<float> direction{"aero/krylov/direction_ghosts",
                                     [this](int t) { return tile_of(t).direction_view(); },
                                     [this](const Tile& t) { return cell_layout(t, gradient_ghosts_count, planar()); },
                                     state_quantities(),
                                     1,
                                     &direction_,
                                     &direction_ghosts_,
                                     3,
                                     &motion_.periodic()};
    record_halo<float>(
        g_, arrays_.grid, arrays_.local, direction, recorded_.float_buffers,
        [this] { return judged_.solving() && !judged_.matrix_free(); }, [](int) {}, {reads(decision_)});
    each(
        "aero/krylov/perturb",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(state_[n]), reads(total_size_), reads(direction_[n]), writes(trial_[n])};
        },
        [this](std::size_t n) {
          if (judged_.perturbs()) system_.perturb(tile(n));
        });
    ghosts_of("aero/krylov/trial_ghosts", trial_, trial_ghosts_, true, 4);
    each(
        "aero/krylov/gradients",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(trial_[n]), reads(trial_ghosts_[n]), writes(gradients_[n])};
        },
        [this](std::size_t n) {
          if (judged_.perturbs()) residual_of_.gradients(tile(n), tile(n).trial.data());
        });
    gradient_ghosts(
        "aero/krylov/gradient_ghosts", [this] { return judged_.perturbs() && residual_of_.has_friction(); }, true, 5);
    for (std::size_t n = 0; n < owned_; ++n)
      g_.task(of("aero/krylov/product", n),
              {reads(decision_), reads(direction_[n]), reads(direction_ghosts_[n]), reads(total_size_), reads(trial_[n]),
               reads(trial_ghosts_[n]), reads(gradients_[n]), reads(gradient_ghosts_[n]), reads(matrix_[n]), reads(past_[n]),
               reads(residual_[n]), updates(vectors_[n]), writes(dots_[n])},
              [this, n](const Context& c) {
                if (judged_.solving())
                  system_.product(tile(n), int(c.iteration), judged_.march().cfl(), judged_.matrix_free(), system_.dots.of(n));
              });
    g_.reduce("aero/krylov/dots", {reads(dots_), reads(decision_), writes(total_dots_)},
              {.partials = system_.dots.partials, .result = system_.dots.result, .active = [this] { return judged_.solving(); }});
    g_.task("aero/krylov/append", {reads(total_dots_), reads(decision_), updates(krylov_)}, [this] {
      if (judged_.solving()) system_.append();
    });
    g_.until("aero/krylov/enough", {reads(krylov_), reads(decision_)},
             [this] { return !judged_.solving() || system_.solved(judged_.march().options().krylov_drop); });
  }

  void vector(std::size_t n, int iteration) {
    if (judged_.solving()) system_.make_vector(tile(n), iteration);
  }
  void direction(std::size_t n, int iteration) {
    system_.direction_size.of(n)[0] = judged_.solving() ? system_.make_direction(tile(n), iteration) : 0.0;
  }
  /// Between what tiles gather and what they make of it; one task of all ranks, beside others of this rank that wait for none of
  /// it.
  void common_part(const char* label) {
    Uses uses{reads(decision_), reads(built_), writes(common_)};
    uses.push_back(reads(gathered_));
    g_.collective(
        label, uses, [this](MPI_Comm comm) { system_.preconditioner().common(comm); }, [this] { return judged_.solving(); });
  }

  void update() {
    g_.task("aero/solution", {reads(decision_), updates(krylov_)}, [this] {
      if (judged_.solving()) system_.cycle().finish();
    });
    const auto update_uses = [&](std::size_t n) {
      return Uses{reads(decision_), reads(krylov_),       reads(matrix_[n]),
                  reads(state_[n]), updates(vectors_[n]), writes(fraction_[n])};
    };
    const bool between = common() && system_.cycle().precondition_at_end();
    if (between) {
      each(
          "aero/combine",
          [&](std::size_t n) {
            return Uses{reads(decision_), reads(krylov_), reads(built_), updates(vectors_[n]), writes(gathered_[n])};
          },
          [this](std::size_t n) {
            if (!judged_.solving()) return;
            system_.cycle().combine(tile(n));
            system_.preconditioner().gather(tile(n), system_.cycle().solution(tile(n)));
          });
      common_part("aero/common");
    }
    each(
        "aero/update",
        [&](std::size_t n) {
          Uses uses = update_uses(n);
          if (between) uses.push_back(reads(common_));
          return uses;
        },
        [this, between](std::size_t n) {
          double& fraction = system_.fraction.of(n)[0];
          fraction = 1.0;
          if (!judged_.solving()) return;
          if (!between) system_.cycle().combine(tile(n));
          system_.solve_for_update(tile(n));
          fraction = system_.update_fraction(tile(n));
        });
    g_.reduce("aero/fraction", {reads(fraction_), writes(total_fraction_)},
              {Reduction::Operation::min, system_.fraction.partials, system_.fraction.result});
    g_.task("aero/updated", {reads(total_fraction_), reads(krylov_), updates(decision_)}, [this] {
      if (!judged_.solving()) return;
      if (system_.fraction.one() < 0.0)
        judged_.march().not_updated();
      else
        judged_.march().updated(system_.fraction.one(), system_.cycle().columns(), system_.linear_drop());
    });
    each(
        "aero/apply",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(total_fraction_), reads(vectors_[n]), updates(state_[n]), updates(trial_[n])};
        },
        [this](std::size_t n) { apply(tile(n)); });
  }

  /// The state after the judgement: a step further, back where it was, or as it is.
  void apply(FlowTile& tile) const {
    const March& march = judged_.march();
    if (march.verdict() == Verdict::go_on) return system_.apply_update(tile);
    if (march.verdict() == Verdict::rejected) {
      std::copy_n(tile.trial.data(), tile.trial.size(), tile.state.data());
      return;
    }
    if (march.verdict() == Verdict::failed && march.rejections() > 0) std::swap(tile.state, tile.trial);
  }

  // ---- ghosts

  void ghosts_of(const char* label, const std::vector<Datum>& inside, const std::vector<Datum>& ghosts, bool trial, int tag) {
    const HaloField<double> field{label,
                                  [this, trial](int t) { return trial ? tile_of(t).trial_view() : tile_of(t).state_view(); },
                                  [this](const Tile& t) { return cell_layout(t, state_ghosts, planar()); },
                                  state_quantities(),
                                  state_ghosts,
                                  &inside,
                                  &ghosts,
                                  tag,
                                  &motion_.periodic()};
    record_halo<double>(
        g_, arrays_.grid, arrays_.local, field, recorded_.double_buffers, [this, trial] { return !trial || judged_.perturbs(); },
        [this, trial](int n) {
          FlowTile& t = tile(std::size_t(n));
          residual_of_.fill_ghosts(t, trial ? t.trial.data() : t.state.data());
        },
        {reads(decision_)});
  }
  void gradient_ghosts(const char* label, std::function<bool()> active, bool trial, int tag) {
    std::vector<Quantity> quantities{Quantity::tensor, Quantity::vector};
    for (int t = 0; t < turbulence(); ++t) quantities.push_back(Quantity::vector);
    if (!arrays_.tiles.empty() && tile(0).eddies)
      quantities.insert(quantities.end(), std::size_t(2 + turbulence()), Quantity::scalar);
    const HaloField<double> field{label,
                                  [this](int t) { return tile_of(t).gradient_view(); },
                                  [this](const Tile& t) { return cell_layout(t, gradient_ghosts_count, planar()); },
                                  quantities,
                                  1,
                                  &gradients_,
                                  &gradient_ghosts_,
                                  tag,
                                  &motion_.periodic()};
    record_halo<double>(g_, arrays_.grid, arrays_.local, field, recorded_.double_buffers, active,
                        [this, trial](int n) {
                          FlowTile& t = tile(std::size_t(n));
                          residual_of_.fill_gradient_ghosts(t, trial ? t.trial.data() : t.state.data());
                        },
                        {reads(decision_)});
  }
  std::vector<Quantity> state_quantities() const {
    std::vector<Quantity> q{Quantity::scalar, Quantity::vector, Quantity::scalar};
    for (int t = 0; t < turbulence(); ++t) q.push_back(Quantity::scalar);
    return q;
  }
  static constexpr int gradient_ghosts_count = aero::gradient_ghosts;

  FlowTile& tile(std::size_t n) const { return arrays_.tiles[n]; }
  FlowTile& tile_of(int index) const { return arrays_.owned(index); }
  bool planar() const { return arrays_.planar(); }
  int turbulence() const { return arrays_.tiles.empty() ? 0 : tile(0).turbulence; }

  TileArrays& arrays_;
  PhysicalTime& time_;
  TileMotion& motion_;
  FlowResidual& residual_of_;
  ImplicitSystem& system_;
  Judgement& judged_;
  RecordedGraphs& recorded_;
  Graph& g_;
  std::size_t owned_;
  std::vector<Datum> state_, state_ghosts_, gradients_, gradient_ghosts_, residual_, matrix_, norms_, vectors_, direction_,
      direction_ghosts_, size_, trial_, trial_ghosts_, dots_, fraction_, past_, gathered_, samples_;
  Datum sampled_, forces_;
  Datum sums_, decision_, total_size_, total_dots_, krylov_, built_, common_, total_fraction_;
};

}  // namespace

void record_march(Graph& graph, const MarchParts& parts, RecordedGraphs& recorded) {
  // The pieces of the graph live on in its tasks.
  auto pieces = std::make_shared<StepGraph>(parts, recorded, graph);
  pieces->record();
  recorded.pieces.push_back(std::move(pieces));
}

void record_geometry(Graph& graph, TileArrays& arrays, const TileMotion& motion, RecordedGraphs& recorded) {
  const std::vector<Datum> inside = graph.data(arrays.tiles.size()), ghosts = graph.data(arrays.tiles.size());
  const HaloData of{inside, ghosts};
  for (std::size_t n = 0; n < arrays.tiles.size(); ++n)
    graph.task("aero/geometry/" + std::to_string(arrays.tiles[n].index), {writes(of.inside[n])}, [] {});
  if (arrays.tiles.empty()) graph.task("aero/geometry", {}, [] {});  // a coarse grid may have fewer tiles than there are ranks
  record_centres(graph, arrays, motion, recorded, of, {});
}

}  // namespace spindrift::aero
