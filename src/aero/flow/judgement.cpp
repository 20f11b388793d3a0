// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "runtime/mpi/exchange.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

namespace {

/// Of `norms`; the mass balance follows what the march needs.
constexpr std::size_t first_of_mass = 10, norm_count = first_of_mass + mass_components;

std::string cell_text(int block, const Index& cell) {
  return fmt::format("block {} cell ({}, {}, {})", block, cell[0], cell[1], cell[2]);
}
std::string place_text(int block, const Index& cell, const std::array<double, 3>& x) {
  return fmt::format("{} at ({:.4g}, {:.4g}, {:.4g}) m", cell_text(block, cell), x[0], x[1], x[2]);
}

/// Sum of squares of what round-off leaves in the scaled residuals of a uniform stream: a part in 1e17 of the pressure on all
/// faces, which is 1 / (gamma M^2) in their units.
double noise_of(const FlowTile& tile, const FlowSetting& s) {
  const double c = gas::sound_speed(s.gas, s.stream), unit = 1e-17 * (1.0 + c * c / (s.speed * s.speed));
  double sum = 0.0;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      double area = 0.0;
      for (int d = 0; d < tile.directions; ++d)
        area += load_face(*tile.geometry, d, k, j, i).area[0] +
                load_face(*tile.geometry, d, k + (d == 2), j + (d == 1), i + (d == 0)).area[0];
      sum += unit * unit * area * area;
    }
  });
  return sum;
}

}  // namespace

void PseudoRows::add(PseudoRow row) {
  all.push_back(std::move(row));
  if (watcher) watcher(all.back());
}

void PseudoRows::keep_last() {
  if (all.size() > 1) all.erase(all.begin(), all.end() - 1);
}

Judgement::Judgement(const FlowSetting& setting, std::vector<PatchCondition> conditions, TileArrays& arrays)
    : march(setting.march),
      conditions_(std::move(conditions)),
      arrays_(arrays),
      unsteady_(setting.time_order > 0),
      stops_anywhere_(unsteady_ || (setting.march.refresh_every == 1 && setting.coarse.common_every == 1)) {
  norms.resize(arrays.tiles.size(), norm_count);
  for (FlowTile& tile : arrays.tiles) {
    tile.noise = noise_of(tile, setting);
    loaded_.push_back(has_loads(tile) ? loaded_tiles_++ : none);
  }
  loads.resize(loaded_tiles_, patch_sums());
  rows.all.reserve(1024);
}

std::size_t Judgement::patch_sums() const { return std::max<std::size_t>(1, conditions_.size()) * load_components; }

void Judgement::gather_bands(LoadBands of) {
  bands_ = std::move(of);
  bands.resize(loaded_tiles_, std::size_t(bands_.count) * band_components);
}

void Judgement::set_body_force(std::shared_ptr<BodyForce> force) {
  if (arrays_.planar()) throw std::invalid_argument("flow: a body force needs a grid of three dimensions");
  body_force_ = std::move(force);
  body_force_->attach(arrays_.tiles.size());
  force_samples.resize(arrays_.tiles.size(), body_force_->sums());
}

void Judgement::begin() {
  solving_ = true;
  if (unsteady_ || march.state().steps == 0) return march.begin_step();
  march.resume();
  if (!rows.all.empty()) rows.all.pop_back();
}

void Judgement::measure(std::size_t owned, const ImplicitSystem& system, const FlowResidual& residual) {
  FlowTile& tile = arrays_.tiles[owned];
  const std::span<double> partial = norms.of(owned);
  const TileGeometry& g = *tile.geometry;
  std::fill(partial.begin(), partial.end(), 0.0);
  partial[5] = tile.noise;
  const Scales& s = system.scales();
  for_rows(tile.box, [&](int k, int j) {
    double density = 0.0, mass = 0.0, mean = 0.0, model = 0.0;
    for (int i = 0; i < tile.box.ni; ++i) {
      const double* r = tile.residual.data() + tile.inner.at(k, j, i);
      const double rate = r[0] / g.volume_data.data()[g.cell_box.at(k, j, i)];
      density += rate * rate, mass += r[0] * r[0];
      for (int c = 0; c < mean_unknowns; ++c) {
        const double scaled = r[c * tile.inner.component] / s.residual[std::size_t(c)];
        mean += scaled * scaled;
      }
      for (int t = 0; t < tile.turbulence; ++t) {
        const double scaled = r[(mean_unknowns + t) * tile.inner.component] / system.model_unit()[std::size_t(t)];
        model += scaled * scaled;
      }
    }
    if (!std::isfinite(density + mean + model)) {
      partial[3] += 1.0;
      tile.limit = {0.0, {0, j, k}, "no finite residual in the row of"};
    }
    partial[0] += density, partial[1] += mean, partial[2] += model, partial[4] += mass;
  });
  partial[6] = runtime::StopRequest::asked() ? 1.0 : 0.0;
  partial[8] = double(tile.limited), partial[9] = double(tile.clipped);
  if (body_force_ && tile.source.size() > 0)
    for_rows(tile.box, [&](int k, int j) {
      double forced = 0.0;
      for (int i = 0; i < tile.box.ni; ++i) {
        const double* f = tile.source.data() + tile.inner.at(k, j, i);
        for (int c = 0; c < mean_unknowns; ++c) {
          const double scaled =
              f[c * tile.inner.component] * g.volume_data.data()[g.cell_box.at(k, j, i)] / s.residual[std::size_t(c)];
          forced += scaled * scaled;
        }
      }
      partial[7] += forced;
    });
  if (loaded_[owned] != none) {
    const std::span<double> on_patches = loads.of(loaded_[owned]), on_bands = bands.of(loaded_[owned]);
    std::ranges::fill(on_patches, 0.0), std::ranges::fill(on_bands, 0.0);
    add_loads(tile, tile.state.data(), residual.viscous(), bands_, on_patches, on_bands);
  }
  const MassBalance mass = residual.mass_balance(tile);
  partial[first_of_mass] = mass.inflow, partial[first_of_mass + 1] = mass.outflow;
  partial[first_of_mass + 2] = mass.growth, partial[first_of_mass + 3] = mass.residual;
}

MassBalance Judgement::mass() const {
  const double* of = norms.result.data() + first_of_mass;
  return {of[0], of[1], of[2], of[3]};
}

Norms Judgement::sums() const {
  return {.density = norms.result[0],
          .mass = norms.result[4],
          .mean = norms.result[1],
          .model = norms.result[2],
          .cells = double(arrays_.cells()),
          .broken = norms.result[3],
          .noise = norms.result[5],
          .forced = norms.result[7],
          .limited = norms.result[8],
          .clipped = norms.result[9]};
}

void Judgement::judge() {
  double force[3] = {0.0, 0.0, 0.0}, moment[3] = {0.0, 0.0, 0.0};
  for (std::size_t p = 0; p < conditions_.size(); ++p)
    if (conditions_[p].loads)
      for (std::size_t c = 0; c < 3; ++c) {
        force[c] += loads.result[p * load_components + c] + loads.result[p * load_components + 3 + c];
        moment[c] += loads.result[p * load_components + 6 + c];
      }
  std::vector<double> bodies;
  if (body_force_) bodies = body_force_->loads();
  const Eigen::Map<const Eigen::Vector3d> on_bodies(bodies.data());
  const double load = body_force_ ? on_bodies.norm() : std::sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
  const MarchState& m = march.state();
  const double cfl = m.steps == 0 ? m.cfl : m.last.cfl;
  const Norms n = sums();
  march.judge(n, load);
  rows.add({.step = int(m.steps_made()),
            .krylov = m.last.krylov,
            .rejections = m.rejections,
            .matrices = matrices_,
            .cfl = cfl,
            .density_residual = m.now.density,
            .mass_residual = m.mass_residual,
            .mean_residual = std::sqrt(n.mean),
            .model_residual = std::sqrt(n.model),
            .balance_drop = m.balance_drop(),
            .fraction = m.last.fraction,
            .limited = m.last.limited,
            .clipped = m.last.clipped,
            .matrix_free = matrix_free_,
            .mass = mass(),
            .force = {force[0], force[1], force[2]},
            .moment = {moment[0], moment[1], moment[2]},
            .loads = loads.result,
            .bodies = std::move(bodies)});
  if (norms.result[6] > 0.0 && m.verdict == Verdict::go_on && stops_anywhere_) march.stop();
  if (m.verdict == Verdict::failed) name_trouble();
  solving_ = m.verdict == Verdict::go_on;
  matrix_free_ = m.matrix_free;
  if (refreshes()) ++matrices_;
}

void Judgement::add_bands() {
  std::vector<double>& row = rows.all.back().loads;
  row.insert(row.end(), bands.result.begin(), bands.result.end());
}

void Judgement::name_trouble() {
  const auto worst = std::ranges::min_element(arrays_.tiles, {}, [](const FlowTile& tile) { return tile.limit.fraction; });
  if (worst == arrays_.tiles.end() || worst->limit.fraction >= 1.0) return;
  const Tile& tile = arrays_.of(*worst);
  trouble_ = fmt::format("; {} {}", worst->limit.what, cell_text(tile.block, tile.to_block(worst->limit.cell)));
}

LimitPlaces limited_cells(const TileArrays& arrays, Updates which, MPI_Comm comm) {
  const auto worst = [&](UpdateLimit FlowTile::*of) {
    LimitPlace place;
    const auto tile = std::ranges::min_element(arrays.tiles, {}, [&](const FlowTile& t) { return (t.*of).fraction; });
    if (tile != arrays.tiles.end() && ((*tile).*of).fraction < place.fraction) {
      const UpdateLimit& limit = (*tile).*of;
      const auto [i, j, k] = limit.cell;
      const BoxLayout& centres = tile->geometry->cell_box;
      const double* x = tile->geometry->centre_data.data() + centres.at(k, j, i);
      place = {limit.fraction, fmt::format("{} {}, to {:.2g} of itself", limit.what,
                                           place_text(arrays.of(*tile).block, arrays.of(*tile).to_block(limit.cell),
                                                      {x[0], x[centres.component], x[2 * centres.component]}),
                                           limit.fraction)};
    }
    runtime::Packer mine;
    mine.put_one(place.fraction), mine.put(std::span<const char>(place.text));
    for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take())) {
      runtime::Unpacker from(bytes);
      const auto other = from.one<double>();
      const std::vector<char> said = from.many<char>();
      if (other < place.fraction) place = {other, std::string(said.begin(), said.end())};
    }
    return place;
  };
  const bool last = which == Updates::last;
  return {worst(last ? &FlowTile::limit : &FlowTile::worst_limit), worst(last ? &FlowTile::clip : &FlowTile::worst_clip)};
}

std::string worst_cells(const TileArrays& arrays, const ImplicitSystem& system, MPI_Comm comm) {
  struct Worst {
    double balance = -1.0;
    int block = 0, unknown = 0;
    Index cell{};
    std::array<double, 3> x{};
  };
  std::array<Worst, 2> worst;  // of the mean flow, of turbulence
  for (const FlowTile& tile : arrays.tiles)
    for_centres(tile, [&](int k, int j, int i, const Eigen::Vector3d& x) {
      for (int c = 0; c < tile.unknowns(); ++c) {
        const bool model = c >= mean_unknowns;
        const Scales& s = system.scales();
        const double unit = model ? system.model_unit()[std::size_t(c - mean_unknowns)] : s.residual[std::size_t(c)],
                     r = std::abs(tile.residual.data()[tile.inner.at(k, j, i) + c * tile.inner.component]) / unit;
        if (Worst& w = worst[model]; !(r <= w.balance))
          w = {r, arrays.of(tile).block, c, arrays.of(tile).to_block({i, j, k}), {x[0], x[1], x[2]}};
      }
    });
  runtime::Packer mine;
  mine.put(std::span<const Worst>(worst));
  worst = {};
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take())) {
    const std::vector<Worst> other = runtime::Unpacker(bytes).many<Worst>();
    for (std::size_t n = 0; n < 2; ++n)
      if (!(other[n].balance <= worst[n].balance)) worst[n] = other[n];
  }
  static constexpr std::array<const char*, mean_unknowns + 2> names{"mass",   "momentum",   "momentum",          "momentum",
                                                                    "energy", "turbulence", "turbulence's omega"};
  std::string text;
  for (const Worst& w : worst)
    if (w.balance >= 0.0)
      text += fmt::format("{}the balance of {} in {}", text.empty() ? "worst are " : " and ", names[std::size_t(w.unknown)],
                          place_text(w.block, w.cell, w.x));
  return text;
}

}  // namespace spindrift::aero
