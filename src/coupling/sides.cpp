// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/sides.hpp"

#include <array>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/retries.hpp"
#include "src/io/machine_failure.hpp"
#include "src/scene/error.hpp"

namespace spindrift::coupling {

namespace {

using runtime::Packer, runtime::Unpacker;

void put(Packer& to, const std::string& text) { to.put(std::span<const char>(text)); }
std::string text(Unpacker& from) {
  const std::vector<char> all = from.many<char>();
  return {all.begin(), all.end()};
}

/// Has the ranks of a part `pack` their result and all ranks `unpack` it. Where the part fails numerically, or the user's
/// files are not what they should be, all throw.
template <class Pack, class Unpack>
void broadcast_from(const runtime::Parts& parts, int part, Pack&& pack, Unpack&& unpack) {
  enum class End : char { result, numerical, lasting, input, stop };
  Packer parcel;
  const auto failed = [&](End end, const std::exception& e) {
    parcel = Packer();
    parcel.put_one(end), put(parcel, e.what());
  };
  if (parts.has(part)) try {
      parcel.put_one(End::result);
      pack(parcel);
    } catch (const NumericalFailure& f) {
      failed(dynamic_cast<const LastingFailure*>(&f) ? End::lasting : End::numerical, f), put(parcel, f.place);
      parcel.put_one(f.step), parcel.put_one(f.time_s), parcel.put_one(f.limit);
    } catch (const io::InputError& e) { failed(End::input, e); } catch (const scene::SceneError& e) {
      failed(End::input, e);
    } catch (const runtime::StopAsked& e) { failed(End::stop, e); }
  const runtime::Bytes bytes = parts.share(part, parcel.take());
  Unpacker from(bytes);
  const End end = from.one<End>();
  if (end == End::result) return unpack(from);
  const std::string what = text(from);
  if (end == End::input) throw io::InputError(what);
  if (end == End::stop) throw runtime::StopAsked();
  const std::string place = text(from);
  const long step = from.one<long>();
  const double t = from.one<double>(), limit = from.one<double>();
  if (end == End::lasting) throw LastingFailure(what, place, step, t, limit);
  throw NumericalFailure(what, place, step, t, limit);
}

void put(Packer& to, const aero::RotorLoad& load) {
  for (const double v : {load.thrust, load.torque, load.power, load.shaft_torque}) to.put_one(v);
  for (const Eigen::Vector3d& v : {load.force, load.moment})
    for (int d = 0; d < 3; ++d) to.put_one(v[d]);
}
aero::RotorLoad rotor_load(Unpacker& from) {
  aero::RotorLoad load;
  for (double* v : {&load.thrust, &load.torque, &load.power, &load.shaft_torque}) *v = from.one<double>();
  for (Eigen::Vector3d* v : {&load.force, &load.moment})
    for (int d = 0; d < 3; ++d) (*v)[d] = from.one<double>();
  return load;
}

class SharedAir final : public AirSide {
 public:
  SharedAir(const runtime::Parts& parts, std::unique_ptr<AirSide> own) : parts_(parts), own_(std::move(own)) {
    broadcast_from(
        parts_, air_part,
        [&](Packer& to) {
          const std::vector<io::Column> columns = own_->columns();
          to.put_one(own_->written() != nullptr), to.put_one(columns.size());
          for (const io::Column& c : columns) put(to, c.name), put(to, c.unit), put(to, c.meaning);
          for (const std::string& sentence : own_->log_lines()) put(to, sentence);
        },
        [&](Unpacker& from) {
          writes_ = from.one<bool>();
          for (std::size_t left = from.one<std::size_t>(); left > 0; --left) {
            std::string name = text(from), unit = text(from);
            columns_.push_back({std::move(name), std::move(unit), text(from)});
          }
          while (!from.done()) log_lines_.push_back(text(from));
        });
  }

  void settle_in(const io::RunDirectory& directory) override {
    if (own_) own_->settle_in(directory);
  }
  aero::RotorLoad begin(double t, const aero::RotorState& now) override {
    return share_results([&] { return own_->begin(t, now); });
  }
  void prepare(double t, double dt, const aero::RotorState& at_end) override {
    if (own_) own_->prepare(t, dt, at_end);
  }
  Tasks record(runtime::Graph& graph) override { return own_ ? own_->record(graph) : Tasks::none; }
  void forget_tasks() override {
    if (own_) own_->forget_tasks();
  }
  bool asks_ranks() const override { return true; }
  aero::RotorLoad load_at_end() override {
    return share_results([&] { return own_->load_at_end(); });
  }
  void ease(int retry) override {
    if (own_) own_->ease(retry);
  }
  const aero::RotorLoad* written() const override { return writes_ ? &results_.load : nullptr; }

  std::optional<aero::TileMove> better_ranks(const Measured& measured) override {
    std::optional<aero::TileMove> move;
    bool moves = false;
    broadcast_from(
        parts_, air_part,
        [&](Packer& to) {
          move = own_->better_ranks(measured);
          to.put_one(move.has_value());
        },
        [&](Unpacker& from) { moves = from.one<bool>(); });
    return moves && !move ? aero::TileMove() : move;
  }
  void move_tiles(const aero::TileMove& move) override {
    const Results results = results_;
    share_results([&] {
      own_->move_tiles(move);
      return results.load;
    });
    results_ = results;  // of the last step, which a solver made anew has not
  }

  void take_snapshot(Snapshot slot) override {
    snapshots_[slot] = results_;
    if (own_) own_->take_snapshot(slot);
  }
  void return_to(Snapshot slot) override {
    results_ = snapshots_[slot];
    if (own_) own_->return_to(slot);
  }
  std::vector<SavedArray> saved() const override { return own_ ? own_->saved() : std::vector<SavedArray>(); }
  void restore(const io::CheckpointReader& file) override {
    share_results([&] {
      own_->restore(file);
      return own_->written() ? *own_->written() : aero::RotorLoad();
    });
  }
  std::vector<io::Column> columns() const override { return columns_; }
  std::vector<double> values() const override { return results_.values; }
  void open_output(const io::RunDirectory& directory, double resume_s) override {
    if (own_) own_->open_output(directory, resume_s);
  }
  Writing copy_fields(std::int64_t number, double t) override { return own_ ? own_->copy_fields(number, t) : Writing(); }
  void write_span() override {
    if (own_) own_->write_span();
  }
  void end_window() override {
    if (own_) own_->end_window();
  }
  void fill_gradients() override {
    if (own_) own_->fill_gradients();
  }
  Account account() const override {
    Account account;
    broadcast_from(
        parts_, air_part,
        [&](Packer& to) {
          const Account own = own_->account();
          to.put_one(own.counts.size());
          for (const auto& [name, count] : own.counts) put(to, name), to.put_one(count);
          to.put_one(own.doubts.size());
          for (const std::string& doubt : own.doubts) put(to, doubt);
          for (const std::vector<std::string>& sentences : {own_->log_lines(), own.sentences})  // what the last window has left
            for (const std::string& sentence : sentences) put(to, sentence);
        },
        [&](Unpacker& from) {
          for (std::size_t left = from.one<std::size_t>(); left > 0; --left) {
            std::string name = text(from);
            account.counts.emplace_back(std::move(name), from.one<std::int64_t>());
          }
          for (std::size_t left = from.one<std::size_t>(); left > 0; --left) account.doubts.push_back(text(from));
          while (!from.done()) account.sentences.push_back(text(from));
        });
    return account;
  }
  std::string failure_at_end() const override {
    std::string failure;
    broadcast_from(
        parts_, air_part, [&](Packer& to) { put(to, own_->failure_at_end()); }, [&](Unpacker& from) { failure = text(from); });
    return failure;
  }
  std::vector<std::string> log_lines() override { return std::exchange(log_lines_, {}); }

 private:
  struct Results {
    aero::RotorLoad load;
    std::vector<double> values;
  };
  /// Has the air's ranks do `work`, which gives a load, and all ranks know load, values and lines for the log after it.
  template <class Work>
  aero::RotorLoad share_results(Work&& work) {
    broadcast_from(
        parts_, air_part,
        [&](Packer& to) {
          put(to, work());
          to.put(std::span<const double>(own_->values()));
          for (const std::string& sentence : own_->log_lines()) put(to, sentence);
        },
        [&](Unpacker& from) {
          results_.load = rotor_load(from), results_.values = from.many<double>();
          while (!from.done()) log_lines_.push_back(text(from));
        });
    return results_.load;
  }
  const runtime::Parts& parts_;
  std::unique_ptr<AirSide> own_;
  bool writes_ = false;
  std::vector<io::Column> columns_;
  Results results_;
  std::array<Results, 2> snapshots_;
  std::vector<std::string> log_lines_;
};

class SharedBodies final : public BodySide {
 public:
  SharedBodies(const runtime::Parts& parts, std::unique_ptr<BodySide> own) : parts_(parts), own_(std::move(own)) {}

  void balance() override {
    if (own_) own_->balance();
  }
  void prepare(const bodies::BodiesState& from, std::int64_t end_tick) override {
    state_ = from;
    if (own_) own_->prepare(from, end_tick);
  }
  Tasks record(runtime::Graph& graph) override { return own_ ? own_->record(graph) : Tasks::none; }
  bodies::BodiesState finish() override {
    broadcast_from(
        parts_, sea_part,
        [&](Packer& to) {
          const bodies::BodiesState end = own_->finish();
          std::vector<double> packed(end.packed_size());
          end.pack(packed);
          to.put(std::span<const double>(packed)), to.put_one(own_->steps()), to.put_one(own_->own_ns());
        },
        [&](Unpacker& from) {
          state_.unpack(from.many<double>());
          steps_ = from.one<std::int64_t>(), own_ns_ = from.one<std::int64_t>();
        });
    return state_;
  }
  void ease(int retry) override {
    if (own_) own_->ease(retry);
  }
  bool outdated() const override { return own_ && own_->outdated(); }
  void forget_tasks() override {
    if (own_) own_->forget_tasks();
  }
  void take_snapshot(int slot) override {
    if (own_) own_->take_snapshot(slot);
  }
  void return_to(int slot) override {
    if (own_) own_->return_to(slot);
  }

 private:
  const runtime::Parts& parts_;
  std::unique_ptr<BodySide> own_;
  bodies::BodiesState state_;
};

}  // namespace

std::unique_ptr<AirSide> share_air(const runtime::Parts& parts, std::unique_ptr<AirSide> own) {
  return std::make_unique<SharedAir>(parts, std::move(own));
}
std::unique_ptr<BodySide> share_bodies(const runtime::Parts& parts, std::unique_ptr<BodySide> own) {
  return std::make_unique<SharedBodies>(parts, std::move(own));
}

void on_parts(const runtime::Parts& parts, const std::function<void()>& work) {
  if (!parts.split()) return work();
  std::string why;
  bool stops = false;
  try {
    work();
  } catch (const scene::SceneError& e) { why = e.what(); } catch (const io::InputError& e) {
    why = e.what();
  } catch (const runtime::StopAsked&) { stops = true; }
  for (const int part : {sea_part, air_part}) {
    Packer parcel;
    parcel.put_one(stops), put(parcel, why);
    const runtime::Bytes bytes = parts.share(part, parcel.take());
    Unpacker from(bytes);
    if (from.one<bool>()) throw runtime::StopAsked();
    if (const std::string said = text(from); !said.empty()) throw io::InputError(said);
  }
}

Sides make_sides(FloatingSystem& floating, std::span<const Motion> start, const runtime::Parts& parts) {
  Sides sides;
  on_parts(parts, [&] {
    if (parts.has(air_part))
      sides.air =
          floating.has_interface() ? make_air(floating, floating.rotor()->state(0.0, start), parts.mine()) : make_no_air();
    if (parts.has(sea_part)) sides.bodies = make_body_side(floating);
  });
  if (!parts.split()) return sides;
  return {share_air(parts, std::move(sides.air)), share_bodies(parts, std::move(sides.bodies))};
}

}  // namespace spindrift::coupling
