// The graph of one march of the air, top to bottom as the algorithm (docs/theory/air.md):
//   until converged: ghosts, gradients, residual, judgement, matrix; Krylov iterations; update.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/tasks.hpp"

#include <cmath>
#include <utility>

#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow/sweep_gradients.hpp"

namespace spindrift::aero {

using namespace runtime;

/// Names of what the tasks share, and the pieces of the graph.
class StepGraph {
 public:
  StepGraph(FlowSolver& solver, Graph& graph) : s_(solver), g_(graph), owned_(solver.tiles_.size()) {
    for (auto* data : {&state_, &state_ghosts_, &gradients_, &gradient_ghosts_, &residual_, &matrix_, &norms_, &vectors_,
                       &direction_, &direction_ghosts_, &size_, &trial_, &trial_ghosts_, &dots_, &fraction_, &past_, &gathered_})
      *data = graph.data(owned_);
    sums_ = graph.datum(), decision_ = graph.datum(), total_size_ = graph.datum(), total_dots_ = graph.datum(),
    krylov_ = graph.datum(), built_ = graph.datum(), common_ = graph.datum(), total_fraction_ = graph.datum();
    if (s_.body_force_) samples_ = graph.data(owned_), sampled_ = graph.datum(), forces_ = graph.datum();
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
    if (s_.setting_.time_order > 0) begin_time_step();
    begin();
    if (s_.moves()) move_grid();
    g_.loop("aero/pseudo", {.min = 1, .max = std::uint32_t(s_.march_.options().max_steps) + 2, .urgency = urgency}, [&] {
      residual_of_state();
      judge();
      each(
          "aero/matrix",
          [&](std::size_t n) {
            return Uses{reads(decision_),     reads(state_[n]),           reads(state_ghosts_[n]),
                        reads(gradients_[n]), reads(gradient_ghosts_[n]), writes(matrix_[n])};
          },
          [this](std::size_t n) { s_.build_matrix(s_.tiles_[n]); });
      if (common()) {
        Uses uses{reads(decision_), writes(built_)};
        uses.push_back(reads(matrix_));
        g_.collective(
            "aero/preconditioner", uses, [this](MPI_Comm comm) { s_.preconditioner_->refresh_common(comm); },
            [this] { return s_.refreshes(); });
      }
      g_.loop("aero/krylov", {.min = 1, .max = std::uint32_t(columns()), .urgency = urgency + 1}, [&] { krylov_iteration(); });
      update();
      g_.until("aero/converged", {reads(decision_)}, [this] { return ends_march(s_.march_.verdict()); });
    });
  }

  int columns() const { return s_.cycle_.most_columns(); }
  bool common() const { return s_.preconditioner_->has_common(); }
  std::string of(const char* path, std::size_t n) const { return std::string(path) + "/" + std::to_string(s_.tiles_[n].index); }
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
        [this](std::size_t n) { s_.begin_time_step(s_.tiles_[n]); });
  }
  void begin() {
    Uses uses{updates(decision_)};
    uses.push_back(reads(past_));
    g_.task("aero/begin", uses, [this] {
      if (s_.setting_.time_order > 0 || s_.march_.steps() == 0)
        s_.march_.begin_step();
      else
        s_.resume();
      s_.solving_ = true;
      s_.preconditioner_->begin(s_.time_steps_);
      if (s_.setting_.time_order > 0) {
        const bool second = s_.setting_.time_order > 1 && s_.time_steps_ > 0;
        s_.weights_ = second ? bdf2(s_.setting_.dt / s_.dt_before_) : bdf1;
        s_.implicit_.physical_rate = s_.weights_.now / s_.setting_.dt;
        s_.boundary_.weights = s_.weights_;
        s_.poses_before_ = std::exchange(s_.poses_, s_.poses_next_);
        s_.dt_before_ = s_.setting_.dt;
        ++s_.time_steps_;
      }
    });
  }

  /// Nodes, metrics and face speeds of the new time level; what follows waits through the states.
  void move_grid() {
    each(
        "aero/move",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(past_[n]), updates(state_[n])};
        },
        [this](std::size_t n) { s_.move_tile(s_.tiles_[n]); });
    s_.record_centres(g_, state_, state_ghosts_, {reads(decision_)});
  }

  void residual_of_state() {
    ghosts_of("aero/ghosts", state_, state_ghosts_, false, 1);
    each(
        "aero/gradients",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(state_[n]), reads(state_ghosts_[n]), writes(gradients_[n])};
        },
        [this](std::size_t n) { s_.slopes(s_.tiles_[n], s_.tiles_[n].state.data()); });
    gradient_ghosts(
        "aero/gradient_ghosts", [this] { return s_.setting_.viscous; }, false, 2);
    if (s_.body_force_) body_force();
    each(
        "aero/residual",
        [&](std::size_t n) {
          Uses uses{reads(state_[n]), reads(state_ghosts_[n]), reads(gradients_[n]), reads(gradient_ghosts_[n]),
                    reads(past_[n]),  reads(decision_),        writes(residual_[n]), writes(norms_[n])};
          if (s_.body_force_) uses.push_back(reads(forces_));
          return uses;
        },
        [this](std::size_t n) {
          FlowTile& tile = s_.tiles_[n];
          if (s_.body_force_) s_.body_force_->spread(n, tile);
          s_.evaluate(tile, tile.state.data(), tile.residual.data());
          const std::size_t loads = s_.loads_.size();
          s_.measure(tile, std::span(s_.norm_partials_).subspan(n * s_.norm_sums_.size(), s_.norm_sums_.size()),
                     std::span(s_.load_partials_).subspan(n * loads, loads));
        });
  }
  /// Forces inside the air, of the flow as it is: products of the linear solver see them as they stand.
  void body_force() {
    const std::size_t width = s_.body_sums_.size();
    each(
        "aero/force/sample",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(state_[n]), writes(samples_[n])};
        },
        [this, width](std::size_t n) {
          s_.body_force_->sample(n, s_.tiles_[n], std::span(s_.body_partials_).subspan(n * width, width));
        });
    g_.reduce("aero/force/sums", {reads(samples_), reads(decision_), writes(sampled_)},
              {.partials = s_.body_partials_, .result = s_.body_sums_});
    g_.task("aero/force/act", {reads(sampled_), reads(decision_), writes(forces_)},
            [this] { s_.body_force_->act(s_.body_sums_); });
  }
  void judge() {
    g_.reduce("aero/norms", {reads(norms_), writes(sums_)}, {.partials = s_.norm_partials_, .result = s_.norm_sums_});
    const Datum loads = g_.datum();
    g_.reduce("aero/loads", {reads(norms_), writes(loads)}, {.partials = s_.load_partials_, .result = s_.loads_});
    g_.task("aero/judge", {reads(sums_), reads(loads), updates(decision_)}, [this] { s_.judge(); });
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
          s_.make_vector(s_.tiles_[n], int(c.iteration));
          direction(n, int(c.iteration));
        });
      }
    } else {
      for (std::size_t n = 0; n < owned_; ++n) {
        Uses uses = vector_uses(n);
        uses.push_back(writes(gathered_[n])), uses.push_back(reads(built_));
        g_.task(of("aero/krylov/vector", n), uses, [this, n](const Context& c) {
          s_.make_vector(s_.tiles_[n], int(c.iteration));
          if (s_.solving_) s_.preconditioner_->gather(s_.tiles_[n], s_.cycle_.source(s_.tiles_[n], int(c.iteration)));
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
              {Reduction::Operation::max, s_.size_partials_, {&s_.direction_size_, 1}, [this] { return perturbs(); }});
    // w = A z: by the stored blocks, or by the residual of a state a little further along z.
    const HaloField<float> direction{"aero/krylov/direction_ghosts",
                                     [this](int t) { return tile_of(t).direction_view(); },
                                     [this](const Tile& t) { return cell_layout(t, gradient_ghosts_count, planar()); },
                                     state_quantities(),
                                     1,
                                     &direction_,
                                     &direction_ghosts_,
                                     3,
                                     &s_.periodic_};
    record_halo<float>(
        g_, s_.grid_, s_.local_, direction, s_.float_buffers_, [this] { return s_.solving_ && !s_.matrix_free_; }, [](int) {},
        {reads(decision_)});
    each(
        "aero/krylov/perturb",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(state_[n]), reads(total_size_), reads(direction_[n]), writes(trial_[n])};
        },
        [this](std::size_t n) {
          if (perturbs()) s_.perturb(s_.tiles_[n]);
        });
    ghosts_of("aero/krylov/trial_ghosts", trial_, trial_ghosts_, true, 4);
    each(
        "aero/krylov/gradients",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(trial_[n]), reads(trial_ghosts_[n]), writes(gradients_[n])};
        },
        [this](std::size_t n) {
          if (perturbs()) s_.slopes(s_.tiles_[n], s_.tiles_[n].trial.data());
        });
    gradient_ghosts(
        "aero/krylov/gradient_ghosts", [this] { return perturbs() && s_.setting_.viscous; }, true, 5);
    for (std::size_t n = 0; n < owned_; ++n)
      g_.task(of("aero/krylov/product", n),
              {reads(decision_), reads(direction_[n]), reads(direction_ghosts_[n]), reads(total_size_), reads(trial_[n]),
               reads(trial_ghosts_[n]), reads(gradients_[n]), reads(gradient_ghosts_[n]), reads(matrix_[n]), reads(past_[n]),
               reads(residual_[n]), updates(vectors_[n]), writes(dots_[n])},
              [this, n](const Context& c) { s_.product(s_.tiles_[n], int(c.iteration), dots_of(n)); });
    g_.reduce("aero/krylov/dots", {reads(dots_), reads(decision_), writes(total_dots_)},
              {.partials = s_.dot_partials_, .result = s_.dots_, .active = [this] { return s_.solving_; }});
    g_.task("aero/krylov/append", {reads(total_dots_), reads(decision_), updates(krylov_)}, [this] {
      if (s_.solving_) s_.cycle_.append(s_.dots_);
    });
    g_.until("aero/krylov/enough", {reads(krylov_), reads(decision_)}, [this] {
      return !s_.solving_ || s_.cycle_.breakdown() ||
             s_.cycle_.residual_norm() <= s_.march_.options().krylov_drop * s_.linear_norm_;
    });
  }

  void direction(std::size_t n, int iteration) {
    s_.precondition_vector(s_.tiles_[n], iteration);
    s_.size_partials_[n] = s_.spread_direction(s_.tiles_[n], iteration);
  }
  /// Between what tiles gather and what they make of it; one task of all ranks, beside others of this rank that wait for none of
  /// it.
  void common_part(const char* label) {
    Uses uses{reads(decision_), reads(built_), writes(common_)};
    uses.push_back(reads(gathered_));
    g_.collective(
        label, uses, [this](MPI_Comm comm) { s_.preconditioner_->common(comm); }, [this] { return s_.solving_; });
  }

  void update() {
    g_.task("aero/solution", {reads(decision_), updates(krylov_)}, [this] {
      if (s_.solving_) s_.cycle_.finish();
    });
    const auto update_uses = [&](std::size_t n) {
      return Uses{reads(decision_), reads(krylov_),       reads(matrix_[n]),
                  reads(state_[n]), updates(vectors_[n]), writes(fraction_[n])};
    };
    const bool between = common() && s_.cycle_.precondition_at_end();
    if (between) {
      each(
          "aero/combine",
          [&](std::size_t n) {
            return Uses{reads(decision_), reads(krylov_), reads(built_), updates(vectors_[n]), writes(gathered_[n])};
          },
          [this](std::size_t n) {
            s_.combine(s_.tiles_[n]);
            if (s_.solving_) s_.preconditioner_->gather(s_.tiles_[n], s_.cycle_.solution(s_.tiles_[n]));
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
          if (!between) s_.combine(s_.tiles_[n]);
          s_.precondition_solution(s_.tiles_[n]);
          s_.fraction_partials_[n] = s_.find_update(s_.tiles_[n]);
        });
    g_.reduce("aero/fraction", {reads(fraction_), writes(total_fraction_)},
              {Reduction::Operation::min, s_.fraction_partials_, {&s_.fraction_, 1}});
    g_.task("aero/updated", {reads(total_fraction_), reads(krylov_), updates(decision_)}, [this] {
      if (!s_.solving_) return;
      if (s_.fraction_ < 0.0)
        s_.march_.not_updated();
      else
        s_.march_.updated(s_.fraction_, s_.cycle_.columns(), s_.cycle_.residual_norm() / s_.linear_norm_);
    });
    each(
        "aero/apply",
        [&](std::size_t n) {
          return Uses{reads(decision_), reads(total_fraction_), reads(vectors_[n]), updates(state_[n]), updates(trial_[n])};
        },
        [this](std::size_t n) { s_.apply_update(s_.tiles_[n]); });
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
                                  &s_.periodic_};
    record_halo<double>(
        g_, s_.grid_, s_.local_, field, s_.double_buffers_, [this, trial] { return !trial || perturbs(); },
        [this, trial](int n) {
          FlowTile& tile = s_.tiles_[std::size_t(n)];
          fill_boundaries(tile, trial ? tile.trial.data() : tile.state.data(), s_.boundary_);
        },
        {reads(decision_)});
  }
  void gradient_ghosts(const char* label, std::function<bool()> active, bool trial, int tag) {
    std::vector<Quantity> quantities{Quantity::tensor, Quantity::vector};
    for (int t = 0; t < turbulence(); ++t) quantities.push_back(Quantity::vector);
    if (!s_.tiles_.empty() && s_.tiles_[0].eddies)
      quantities.insert(quantities.end(), std::size_t(2 + turbulence()), Quantity::scalar);
    const HaloField<double> field{label,
                                  [this](int t) { return tile_of(t).gradient_view(); },
                                  [this](const Tile& t) { return cell_layout(t, gradient_ghosts_count, planar()); },
                                  quantities,
                                  1,
                                  &gradients_,
                                  &gradient_ghosts_,
                                  tag,
                                  &s_.periodic_};
    record_halo<double>(g_, s_.grid_, s_.local_, field, s_.double_buffers_, active,
                        [this, trial](int n) {
                          FlowTile& tile = s_.tiles_[std::size_t(n)];
                          fill_boundary_gradients(tile, trial ? tile.trial.data() : tile.state.data(), s_.setting_.gas,
                                                  s_.model_->wall_spread);
                        },
                        {reads(decision_)});
  }
  std::vector<Quantity> state_quantities() const {
    std::vector<Quantity> q{Quantity::scalar, Quantity::vector, Quantity::scalar};
    for (int t = 0; t < turbulence(); ++t) q.push_back(Quantity::scalar);
    return q;
  }
  static constexpr int gradient_ghosts_count = aero::gradient_ghosts;

  FlowTile& tile_of(int tile) { return s_.tiles_[std::size_t(s_.local_[std::size_t(tile)])]; }
  bool planar() const { return s_.grid_.tiling().planar; }
  int turbulence() const { return s_.tiles_.empty() ? 0 : s_.tiles_[0].turbulence; }
  bool perturbs() const { return s_.solving_ && s_.matrix_free_; }
  std::span<double> dots_of(std::size_t n) {
    const std::size_t width = s_.dots_.size();
    return std::span(s_.dot_partials_).subspan(n * width, width);
  }

  FlowSolver& s_;
  Graph& g_;
  std::size_t owned_;
  std::vector<Datum> state_, state_ghosts_, gradients_, gradient_ghosts_, residual_, matrix_, norms_, vectors_, direction_,
      direction_ghosts_, size_, trial_, trial_ghosts_, dots_, fraction_, past_, gathered_, samples_;
  Datum sampled_, forces_;
  Datum sums_, decision_, total_size_, total_dots_, krylov_, built_, common_, total_fraction_;
};

void FlowSolver::record(Graph& graph) {
  // The pieces of the graph live on in its tasks.
  auto pieces = std::make_shared<StepGraph>(*this, graph);
  pieces->record();
  pieces_.push_back(std::move(pieces));
}

void FlowSolver::record_geometry(Graph& graph) {
  const std::vector<Datum> nodes = graph.data(tiles_.size()), ghosts = graph.data(tiles_.size());
  for (std::size_t n = 0; n < tiles_.size(); ++n)
    graph.task("aero/geometry/" + std::to_string(tiles_[n].index), {writes(nodes[n])}, [] {});
  if (tiles_.empty()) graph.task("aero/geometry", {}, [] {});  // a coarse grid may have fewer tiles than there are ranks
  record_centres(graph, nodes, ghosts, {});
}

/// Ghosts of centres and volumes, from tiles here and on other ranks.
void FlowSolver::record_centres(Graph& graph, const std::vector<Datum>& nodes, const std::vector<Datum>& ghosts,
                                const std::vector<Use>& control) {
  const auto view = [this](int t) -> TileGeometry& { return grid_[t]; };
  const auto layout = [this](const Tile& t) { return cell_layout(t, cell_ghosts, grid_.tiling().planar); };
  const HaloField<double> centre{
      "aero/centres", [view](int t) { return view(t).centre(); }, layout, {Quantity::point}, cell_ghosts, &nodes, &ghosts, 6,
      &periodic_};
  const HaloField<double> volume{
      "aero/volumes", [view](int t) { return view(t).volume(); }, layout, {Quantity::scalar}, cell_ghosts, &nodes, &ghosts, 7,
      &periodic_};
  const auto always = [] { return true; };
  record_halo<double>(
      graph, grid_, local_, centre, double_buffers_, always, [](int) {}, control);
  record_halo<double>(
      graph, grid_, local_, volume, double_buffers_, always, [](int) {}, control);
}

}  // namespace spindrift::aero
