// The graph of one march of the air, top to bottom as the algorithm (docs/theory/air.md):
//   until converged: ghosts, gradients, residual, judgement, matrix; Krylov iterations; update.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/tasks.hpp"

#include <algorithm>
#include <charconv>
#include <functional>
#include <memory>
#include <string_view>
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

/// Data of the tasks of the flow, by owned tile where there are several.
struct FlowData {
  std::vector<Datum> state, state_ghosts, gradients, gradient_ghosts, residual, matrix, norms, past;
  Datum sums;      ///< of the norms, over all tiles
  Datum decision;  ///< of the judgement: whether and how the march goes on

  FlowData(Graph& graph, std::size_t tiles) : sums(graph.datum()), decision(graph.datum()) {
    for (auto* data : {&state, &state_ghosts, &gradients, &gradient_ghosts, &residual, &matrix, &norms, &past})
      *data = graph.data(tiles);
  }
};

/// Data of the tasks of the linear system. `trial`: the state that products without a matrix perturb.
struct KrylovData {
  std::vector<Datum> vectors, direction, direction_ghosts, size, trial, trial_ghosts, dots, fraction, gathered;
  Datum basis;  ///< its dense part
  Datum total_size, total_dots, total_fraction;
  Datum built, coarse;  ///< the preconditioner's coarse level: its matrix, its solution

  KrylovData(Graph& graph, std::size_t tiles)
      : basis(graph.datum()),
        total_size(graph.datum()),
        total_dots(graph.datum()),
        total_fraction(graph.datum()),
        built(graph.datum()),
        coarse(graph.datum()) {
    for (auto* data : {&vectors, &direction, &direction_ghosts, &size, &trial, &trial_ghosts, &dots, &fraction, &gathered})
      *data = graph.data(tiles);
  }
};

/// Data of the tasks of a force inside the air; none without one.
struct ForceData {
  std::vector<Datum> samples;
  Datum sampled, forces;
};

/// The parts of a march and the data of its tasks, which refer to it while they run.
struct MarchRecording : MarchParts {
  RecordedGraphs& recorded;
  Graph& graph;
  FlowData flow;
  KrylovData krylov;
  ForceData force{};

  MarchRecording(const MarchParts& parts, RecordedGraphs& recorded, Graph& graph)
      : MarchParts(parts), recorded(recorded), graph(graph), flow(graph, owned()), krylov(graph, owned()) {
    if (judgement.body_force()) force = {graph.data(owned()), graph.datum(), graph.datum()};
  }
  MarchRecording(const MarchRecording&) = delete;
  MarchRecording& operator=(const MarchRecording&) = delete;

  std::size_t owned() const { return arrays.tiles.size(); }
  FlowTile& tile(std::size_t n) const { return arrays.tiles[n]; }
  FlowTile& tile_of(int index) const { return arrays.owned(index); }
  /// tile_of() reads it back.
  std::string of(const char* path, std::size_t n) const { return std::string(path) + "/" + std::to_string(tile(n).index); }
  /// A task for each owned tile.
  template <class UsesOf, class Work>
  void each(const char* path, UsesOf&& uses, Work work) {
    for (std::size_t n = 0; n < owned(); ++n) graph.task(of(path, n), uses(n), [work, n] { work(n); });
  }
  /// Whether the preconditioner has a part of all tiles together.
  bool has_coarse_level() const { return system.preconditioner().has_coarse_level(); }
  int turbulence() const { return arrays.tiles.empty() ? 0 : tile(0).turbulence; }
  std::vector<Quantity> state_quantities() const {
    std::vector<Quantity> q{Quantity::scalar, Quantity::vector, Quantity::scalar};
    for (int t = 0; t < turbulence(); ++t) q.push_back(Quantity::scalar);
    return q;
  }
};

// ---- ghosts

void ghosts_of(MarchRecording& r, const char* label, const std::vector<Datum>& inside, const std::vector<Datum>& ghosts,
               bool trial, int tag) {
  const HaloField<double> field{label,
                                [&r, trial](int t) { return trial ? r.tile_of(t).trial_view() : r.tile_of(t).state_view(); },
                                [&r](const Tile& t) { return cell_layout(t, state_ghosts, r.arrays.planar()); },
                                r.state_quantities(),
                                state_ghosts,
                                &inside,
                                &ghosts,
                                tag,
                                &r.motion.periodic()};
  record_halo<double>(
      r.graph, r.arrays.grid, r.arrays.local, field, r.recorded.double_buffers,
      [&r, trial] { return !trial || r.judgement.perturbs(); },
      [&r, trial](int n) {
        FlowTile& t = r.tile(std::size_t(n));
        r.residual.fill_ghosts(t, trial ? t.trial.data() : t.state.data());
      },
      {reads(r.flow.decision)});
}

void ghosts_of_gradients(MarchRecording& r, const char* label, std::function<bool()> active, bool trial, int tag) {
  std::vector<Quantity> quantities{Quantity::tensor, Quantity::vector};
  for (int t = 0; t < r.turbulence(); ++t) quantities.push_back(Quantity::vector);
  if (!r.arrays.tiles.empty() && r.tile(0).eddies)
    quantities.insert(quantities.end(), std::size_t(2 + r.turbulence()), Quantity::scalar);
  const HaloField<double> field{label,
                                [&r](int t) { return r.tile_of(t).gradient_view(); },
                                [&r](const Tile& t) { return cell_layout(t, gradient_ghosts, r.arrays.planar()); },
                                quantities,
                                1,
                                &r.flow.gradients,
                                &r.flow.gradient_ghosts,
                                tag,
                                &r.motion.periodic()};
  record_halo<double>(r.graph, r.arrays.grid, r.arrays.local, field, r.recorded.double_buffers, active,
                      [&r, trial](int n) {
                        FlowTile& t = r.tile(std::size_t(n));
                        r.residual.fill_gradient_ghosts(t, trial ? t.trial.data() : t.state.data());
                      },
                      {reads(r.flow.decision)});
}

// ---- the residual

/// The past moves back by one step; ordered before all that reads the state.
void begin_time_step(MarchRecording& r) {
  r.each(
      "aero/past",
      [&](std::size_t n) {
        return Uses{reads(r.flow.state[n]), updates(r.flow.past[n])};
      },
      [&r](std::size_t n) { r.residual.keep_past(r.tile(n)); });
}

void begin_march(MarchRecording& r) {
  Uses uses{updates(r.flow.decision)};
  uses.push_back(reads(r.flow.past));
  r.graph.task("aero/begin", uses, [&r] {
    r.judgement.begin();
    r.system.preconditioner().begin(r.time.steps);
    if (!r.time.unsteady()) return;
    r.time.begin_step();
    r.residual.begin_step();
    r.system.set_physical_rate(r.time.weights.now / r.time.dt);
    r.motion.begin_step();
  });
}

/// Nodes, metrics and face speeds of the new time level, and how the wind drives the air there; what follows waits through the
/// states.
void move_grid(MarchRecording& r) {
  r.each(
      "aero/move",
      [&](std::size_t n) {
        return Uses{reads(r.flow.decision), reads(r.flow.past[n]), updates(r.flow.state[n])};
      },
      [&r](std::size_t n) {
        r.motion.move(r.tile(n));
        r.residual.drive_moved(r.tile(n));
      });
  record_centres(r.graph, r.arrays, r.motion, r.recorded, {r.flow.state, r.flow.state_ghosts}, {reads(r.flow.decision)});
}

/// Forces inside the air, of the flow as it is: products of the linear solver hold them fixed.
void body_force(MarchRecording& r) {
  r.each(
      "aero/force/sample",
      [&](std::size_t n) {
        return Uses{reads(r.flow.decision), reads(r.flow.state[n]), writes(r.force.samples[n])};
      },
      [&r](std::size_t n) { r.judgement.body_force()->sample(n, r.tile(n), r.judgement.force_samples.of(n)); });
  TileSums& sums = r.judgement.force_samples;
  r.graph.reduce("aero/force/sums", {reads(r.force.samples), reads(r.flow.decision), writes(r.force.sampled)},
                 {.partials = sums.partials, .result = sums.result});
  r.graph.task("aero/force/act", {reads(r.force.sampled), reads(r.flow.decision), writes(r.force.forces)},
               [&r] { r.judgement.body_force()->act(r.judgement.force_samples.result); });
}

void gradients_of_state(MarchRecording& r) {
  ghosts_of(r, "aero/ghosts", r.flow.state, r.flow.state_ghosts, false, 1);
  r.each(
      "aero/gradients",
      [&](std::size_t n) {
        return Uses{reads(r.flow.decision), reads(r.flow.state[n]), reads(r.flow.state_ghosts[n]), writes(r.flow.gradients[n])};
      },
      [&r](std::size_t n) { r.residual.gradients(r.tile(n), r.tile(n).state.data()); });
  ghosts_of_gradients(
      r, "aero/gradient_ghosts", [&r] { return r.residual.has_friction(); }, false, 2);
}

void residual_of_state(MarchRecording& r) {
  gradients_of_state(r);
  if (r.judgement.body_force()) body_force(r);
  r.each(
      "aero/residual",
      [&](std::size_t n) {
        Uses uses{reads(r.flow.state[n]),           reads(r.flow.state_ghosts[n]), reads(r.flow.gradients[n]),
                  reads(r.flow.gradient_ghosts[n]), reads(r.flow.past[n]),         reads(r.flow.decision),
                  writes(r.flow.residual[n]),       writes(r.flow.norms[n])};
        if (r.judgement.body_force()) uses.push_back(reads(r.force.forces));
        return uses;
      },
      [&r](std::size_t n) {
        if (r.judgement.body_force()) r.judgement.body_force()->spread(n, r.tile(n));
        r.residual.evaluate(r.tile(n), r.tile(n).state.data(), r.tile(n).residual.data());
        r.judgement.measure(n, r.system, r.residual);
      });
}

void judge(MarchRecording& r) {
  r.graph.reduce("aero/norms", {reads(r.flow.norms), writes(r.flow.sums)},
                 {.partials = r.judgement.norms.partials, .result = r.judgement.norms.result});
  const Datum loads = r.graph.datum();
  r.graph.reduce("aero/loads", {reads(r.flow.norms), writes(loads)},
                 {.partials = r.judgement.loads.partials, .result = r.judgement.loads.result});
  r.graph.task("aero/judge", {reads(r.flow.sums), reads(loads), updates(r.flow.decision)}, [&r] {
    r.judgement.judge();
    if (!r.judgement.solving()) return;
    const Norms n = r.judgement.sums();
    r.system.begin(n.mean, n.model, r.judgement.refreshes());
  });
  TileSums& bands = r.judgement.bands;
  if (bands.result.empty()) return;
  const Datum of_bands = r.graph.datum();
  r.graph.reduce("aero/loads/bands", {reads(r.flow.norms), reads(r.flow.decision), writes(of_bands)},
                 {.partials = bands.partials, .result = bands.result, .active = [&r] { return r.judgement.takes_bands(); }});
  r.graph.task("aero/loads/row", {reads(of_bands), reads(r.flow.decision)}, [&r] {
    if (r.judgement.takes_bands()) r.judgement.add_bands();
  });
}

// ---- the linear system and the update

void make_vector(const MarchRecording& r, std::size_t n, int iteration) {
  if (r.judgement.solving()) r.system.make_vector(r.tile(n), iteration);
}

void make_direction(const MarchRecording& r, std::size_t n, int iteration) {
  r.system.direction_size.of(n)[0] = r.judgement.solving() ? r.system.make_direction(r.tile(n), iteration) : 0.0;
}

/// Between what tiles gather and what they make of it; one task of all ranks, beside others of this rank that wait for none of
/// it.
void solve_coarse_level(MarchRecording& r, const char* label) {
  Uses uses{reads(r.flow.decision), reads(r.krylov.built), writes(r.krylov.coarse)};
  uses.push_back(reads(r.krylov.gathered));
  r.graph.collective(
      label, uses, [&r](MPI_Comm comm) { r.system.preconditioner().solve_coarse_level(comm); },
      [&r] { return r.judgement.solving(); });
}

void krylov_iteration(MarchRecording& r) {
  // v_j, and the direction z = M^-1 v_j.
  const auto vector_uses = [&](std::size_t n) {
    return Uses{reads(r.flow.decision), reads(r.krylov.basis), reads(r.flow.residual[n]), updates(r.krylov.vectors[n])};
  };
  const auto direction_uses = [&](std::size_t n) {
    return Uses{reads(r.flow.decision), reads(r.flow.matrix[n]), updates(r.krylov.vectors[n]), writes(r.krylov.direction[n]),
                writes(r.krylov.size[n])};
  };
  if (!r.has_coarse_level()) {
    for (std::size_t n = 0; n < r.owned(); ++n) {
      Uses uses = direction_uses(n);
      uses.push_back(reads(r.krylov.basis)), uses.push_back(reads(r.flow.residual[n]));
      r.graph.task(r.of("aero/krylov/direction", n), uses, [&r, n](const Context& c) {
        make_vector(r, n, int(c.iteration));
        make_direction(r, n, int(c.iteration));
      });
    }
  } else {
    for (std::size_t n = 0; n < r.owned(); ++n) {
      Uses uses = vector_uses(n);
      uses.push_back(writes(r.krylov.gathered[n])), uses.push_back(reads(r.krylov.built));
      r.graph.task(r.of("aero/krylov/vector", n), uses, [&r, n](const Context& c) {
        make_vector(r, n, int(c.iteration));
        if (r.judgement.solving())
          r.system.preconditioner().gather(r.tile(n), r.system.cycle().source(r.tile(n), int(c.iteration)));
      });
    }
    solve_coarse_level(r, "aero/krylov/coarse");
    for (std::size_t n = 0; n < r.owned(); ++n) {
      Uses uses = direction_uses(n);
      uses.push_back(reads(r.krylov.coarse));
      r.graph.task(r.of("aero/krylov/direction", n), uses, [&r, n](const Context& c) { make_direction(r, n, int(c.iteration)); });
    }
  }
  r.graph.reduce("aero/krylov/size", {reads(r.krylov.size), reads(r.flow.decision), writes(r.krylov.total_size)},
                 {Reduction::Operation::max, r.system.direction_size.partials, r.system.direction_size.result,
                  [&r] { return r.judgement.perturbs(); }});
  // w = A z: by the stored blocks, or by the residual of a state a little further along z.
  const HaloField<float> direction{"aero/krylov/direction_ghosts",
                                   [&r](int t) { return r.tile_of(t).direction_view(); },
                                   [&r](const Tile& t) { return cell_layout(t, gradient_ghosts, r.arrays.planar()); },
                                   r.state_quantities(),
                                   1,
                                   &r.krylov.direction,
                                   &r.krylov.direction_ghosts,
                                   3,
                                   &r.motion.periodic()};
  record_halo<float>(
      r.graph, r.arrays.grid, r.arrays.local, direction, r.recorded.float_buffers,
      [&r] { return r.judgement.solving() && !r.judgement.matrix_free(); }, [](int) {}, {reads(r.flow.decision)});
  r.each(
      "aero/krylov/perturb",
      [&](std::size_t n) {
        return Uses{reads(r.flow.decision), reads(r.flow.state[n]), reads(r.krylov.total_size), reads(r.krylov.direction[n]),
                    writes(r.krylov.trial[n])};
      },
      [&r](std::size_t n) {
        if (r.judgement.perturbs()) r.system.perturb(r.tile(n));
      });
  ghosts_of(r, "aero/krylov/trial_ghosts", r.krylov.trial, r.krylov.trial_ghosts, true, 4);
  r.each(
      "aero/krylov/gradients",
      [&](std::size_t n) {
        return Uses{reads(r.flow.decision), reads(r.krylov.trial[n]), reads(r.krylov.trial_ghosts[n]),
                    writes(r.flow.gradients[n])};
      },
      [&r](std::size_t n) {
        if (r.judgement.perturbs()) r.residual.gradients(r.tile(n), r.tile(n).trial.data());
      });
  ghosts_of_gradients(
      r, "aero/krylov/gradient_ghosts", [&r] { return r.judgement.perturbs() && r.residual.has_friction(); }, true, 5);
  for (std::size_t n = 0; n < r.owned(); ++n)
    r.graph.task(r.of("aero/krylov/product", n),
                 {reads(r.flow.decision), reads(r.krylov.direction[n]), reads(r.krylov.direction_ghosts[n]),
                  reads(r.krylov.total_size), reads(r.krylov.trial[n]), reads(r.krylov.trial_ghosts[n]),
                  reads(r.flow.gradients[n]), reads(r.flow.gradient_ghosts[n]), reads(r.flow.matrix[n]), reads(r.flow.past[n]),
                  reads(r.flow.residual[n]), updates(r.krylov.vectors[n]), writes(r.krylov.dots[n])},
                 [&r, n](const Context& c) {
                   if (r.judgement.solving())
                     r.system.product(r.tile(n), int(c.iteration), r.judgement.march.state().cfl, r.judgement.matrix_free(),
                                      r.system.dots.of(n));
                 });
  r.graph.reduce(
      "aero/krylov/dots", {reads(r.krylov.dots), reads(r.flow.decision), writes(r.krylov.total_dots)},
      {.partials = r.system.dots.partials, .result = r.system.dots.result, .active = [&r] { return r.judgement.solving(); }});
  r.graph.task("aero/krylov/append", {reads(r.krylov.total_dots), reads(r.flow.decision), updates(r.krylov.basis)}, [&r] {
    if (r.judgement.solving()) r.system.append();
  });
  r.graph.until("aero/krylov/enough", {reads(r.krylov.basis), reads(r.flow.decision)},
                [&r] { return !r.judgement.solving() || r.system.solved(r.judgement.march.options().krylov_drop); });
}

/// The state after the judgement: a step further, back where it was, or as it is.
void apply(const MarchRecording& r, FlowTile& tile) {
  const MarchState& march = r.judgement.march.state();
  if (march.verdict == Verdict::go_on) return r.system.apply_update(tile);
  if (march.verdict == Verdict::rejected) {
    std::copy_n(tile.trial.data(), tile.trial.size(), tile.state.data());
    return;
  }
  if (march.verdict == Verdict::failed && march.rejections > 0) std::swap(tile.state, tile.trial);
}

void update_state(MarchRecording& r) {
  r.graph.task("aero/solution", {reads(r.flow.decision), updates(r.krylov.basis)}, [&r] {
    if (r.judgement.solving()) r.system.cycle().finish();
  });
  const auto update_uses = [&](std::size_t n) {
    return Uses{reads(r.flow.decision), reads(r.krylov.basis),        reads(r.flow.matrix[n]),
                reads(r.flow.state[n]), updates(r.krylov.vectors[n]), writes(r.krylov.fraction[n])};
  };
  const bool between = r.has_coarse_level() && r.system.cycle().precondition_at_end();
  if (between) {
    r.each(
        "aero/combine",
        [&](std::size_t n) {
          return Uses{reads(r.flow.decision), reads(r.krylov.basis), reads(r.krylov.built), updates(r.krylov.vectors[n]),
                      writes(r.krylov.gathered[n])};
        },
        [&r](std::size_t n) {
          if (!r.judgement.solving()) return;
          r.system.cycle().combine(r.tile(n));
          r.system.preconditioner().gather(r.tile(n), r.system.cycle().solution(r.tile(n)));
        });
    solve_coarse_level(r, "aero/coarse");
  }
  r.each(
      "aero/update",
      [&](std::size_t n) {
        Uses uses = update_uses(n);
        if (between) uses.push_back(reads(r.krylov.coarse));
        return uses;
      },
      [&r, between](std::size_t n) {
        double& fraction = r.system.fraction.of(n)[0];
        fraction = 1.0;
        if (!r.judgement.solving()) return;
        if (!between) r.system.cycle().combine(r.tile(n));
        r.system.solve_for_update(r.tile(n));
        fraction = r.system.update_fraction(r.tile(n));
      });
  r.graph.reduce("aero/fraction", {reads(r.krylov.fraction), writes(r.krylov.total_fraction)},
                 {Reduction::Operation::min, r.system.fraction.partials, r.system.fraction.result});
  r.graph.task("aero/updated", {reads(r.krylov.total_fraction), reads(r.krylov.basis), updates(r.flow.decision)}, [&r] {
    if (!r.judgement.solving()) return;
    if (r.system.fraction.one() < 0.0)
      r.judgement.march.not_updated();
    else
      r.judgement.march.updated(r.system.fraction.one(), r.system.cycle().columns(), r.system.linear_drop());
  });
  r.each(
      "aero/apply",
      [&](std::size_t n) {
        return Uses{reads(r.flow.decision), reads(r.krylov.total_fraction), reads(r.krylov.vectors[n]), updates(r.flow.state[n]),
                    updates(r.krylov.trial[n])};
      },
      [&r](std::size_t n) { apply(r, r.tile(n)); });
}

// ---- the march

/// Of the physical step that has been made.
void time_error(MarchRecording& r) {
  const std::vector<Datum> error = r.graph.data(r.owned());
  r.each(
      "aero/time_error",
      [&](std::size_t n) {
        return Uses{reads(r.flow.decision), reads(r.flow.state[n]), reads(r.flow.past[n]), writes(error[n])};
      },
      [&r](std::size_t n) { r.time_error.measure(n); });
  r.graph.reduce("aero/time_error/sums", {reads(error), writes(r.graph.datum())},
                 {.partials = r.time_error.sums.partials, .result = r.time_error.sums.result});
}

void pseudo_march(MarchRecording& r, int urgency) {
  if (r.time.unsteady()) begin_time_step(r);
  begin_march(r);
  if (r.motion.moves()) move_grid(r);
  r.graph.loop(
      "aero/pseudo", {.min = 1, .max = std::uint32_t(r.judgement.march.options().max_steps) + 2, .urgency = urgency}, [&] {
        residual_of_state(r);
        judge(r);
        r.each(
            "aero/matrix",
            [&](std::size_t n) {
              return Uses{reads(r.flow.decision),     reads(r.flow.state[n]),           reads(r.flow.state_ghosts[n]),
                          reads(r.flow.gradients[n]), reads(r.flow.gradient_ghosts[n]), writes(r.flow.matrix[n])};
            },
            [&r](std::size_t n) {
              if (r.judgement.solving()) r.system.build(r.tile(n), r.judgement.march.state().cfl, r.judgement.refreshes());
            });
        if (r.has_coarse_level()) {
          Uses uses{reads(r.flow.decision), writes(r.krylov.built)};
          uses.push_back(reads(r.flow.matrix));
          r.graph.collective(
              "aero/preconditioner", uses, [&r](MPI_Comm comm) { r.system.preconditioner().refresh_coarse_level(comm); },
              [&r] { return r.judgement.refreshes(); });
        }
        r.graph.loop("aero/krylov", {.min = 1, .max = std::uint32_t(r.system.cycle().most_columns()), .urgency = urgency + 1},
                     [&] { krylov_iteration(r); });
        update_state(r);
        r.graph.until("aero/converged", {reads(r.flow.decision)}, [&r] { return ends_march(r.judgement.march.state().verdict); });
      });
  if (r.time_error.asked()) time_error(r);
}

}  // namespace

void record_march(Graph& graph, const MarchParts& parts, RecordedGraphs& recorded) {
  auto recording = std::make_shared<MarchRecording>(parts, recorded, graph);
  recorded.pieces.push_back(recording);
  MarchRecording& r = *recording;
  // A coarse level is one thread's work: with one, all of the air is more urgent than the sea (1), so that it comes there while
  // the others still have a sea to go on with. The round of one gives what stands outside the march's own loops that urgency
  // too.
  if (r.has_coarse_level())
    graph.loop("aero/step", {.min = 1, .max = 1, .urgency = 2}, [&] { pseudo_march(r, 2); });
  else
    pseudo_march(r, 0);
}

int tile_of(const Node& task) {
  const std::string_view label = task.label, number = label.substr(label.rfind('/') + 1);
  if (task.kind != NodeKind::task || task.module() != "aero" || label.find("/pack/") != label.npos) return -1;  // to a rank
  int tile = -1;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), tile);
  return error == std::errc() && end == number.data() + number.size() ? tile : -1;
}

void record_geometry(Graph& graph, TileArrays& arrays, const TileMotion& motion, RecordedGraphs& recorded) {
  const std::vector<Datum> inside = graph.data(arrays.tiles.size()), ghosts = graph.data(arrays.tiles.size());
  const HaloData of{inside, ghosts};
  for (std::size_t n = 0; n < arrays.tiles.size(); ++n)
    graph.task("aero/geometry/" + std::to_string(arrays.tiles[n].index), {writes(of.inside[n])}, [] {});
  if (arrays.tiles.empty()) graph.task("aero/geometry", {}, [] {});  // a coarse grid may have fewer tiles than there are ranks
  record_centres(graph, arrays, motion, recorded, of, {});
}

void record_gradients(Graph& graph, const MarchParts& parts, RecordedGraphs& recorded) {
  auto recording = std::make_shared<MarchRecording>(parts, recorded, graph);
  recorded.pieces.push_back(recording);
  MarchRecording& r = *recording;
  r.each(
      "aero/geometry", [&](std::size_t n) { return Uses{writes(r.flow.state[n])}; }, [](std::size_t) {});
  if (r.owned() == 0) graph.task("aero/geometry", {}, [] {});
  record_centres(graph, r.arrays, r.motion, recorded, {r.flow.state, r.flow.state_ghosts}, {});
  gradients_of_state(r);
}

}  // namespace spindrift::aero
