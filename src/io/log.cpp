// SPDX-License-Identifier: Apache-2.0
#include "src/io/log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "src/io/console.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace {

std::atomic<std::int64_t> warnings{0};
int rank_of_log = 0;

/// Prints above the progress line; warnings and errors go to standard error.
class ConsoleSink : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t text;
    formatter_->format(message, text);
    console::print({text.data(), text.size()}, message.level >= spdlog::level::warn);
  }
  void flush_() override {}
};

class CountingSink : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (message.level == spdlog::level::warn) ++warnings;
  }
  void flush_() override {}
};

/// "warning: text"; what is merely said carries no label.
class ConsoleFormatter : public spdlog::formatter {
 public:
  explicit ConsoleFormatter(std::string prefix) : prefix_(std::move(prefix)) {}
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& out) override {
    const auto append = [&out](std::string_view text) { out.append(text.data(), text.data() + text.size()); };
    append(prefix_);
    if (message.level == spdlog::level::warn) append("warning: ");
    if (message.level >= spdlog::level::err) append("error: ");
    append({message.payload.data(), message.payload.size()});
  }
  std::unique_ptr<spdlog::formatter> clone() const override { return std::make_unique<ConsoleFormatter>(prefix_); }

 private:
  std::string prefix_;
};

}  // namespace

void start_log(int rank, bool quiet) {
  warnings = 0, rank_of_log = rank;
  auto sink = std::make_shared<ConsoleSink>();
  sink->set_formatter(std::make_unique<ConsoleFormatter>(rank == 0 ? "" : "rank " + std::to_string(rank) + ": "));
  sink->set_level(rank != 0 ? spdlog::level::err : quiet ? spdlog::level::warn : spdlog::level::info);
  auto logger =
      std::make_shared<spdlog::logger>("spindrift", spdlog::sinks_init_list{std::move(sink), std::make_shared<CountingSink>()});
  spdlog::set_default_logger(std::move(logger));
}

void log_to_file(int rank, const std::filesystem::path& path) {
  if (rank != 0) return;
  try {
    auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>(path.string());
    file->set_pattern("%Y-%m-%d %H:%M:%S.%e %-8l %v");
    spdlog::default_logger()->sinks().push_back(std::move(file));
    spdlog::default_logger()->set_level(spdlog::level::debug);  // to the file alone: the console has a level of its own
    // Line by line: what a killed run said last is what is wanted.
    spdlog::default_logger()->flush_on(spdlog::level::info);
  } catch (const spdlog::spdlog_ex& error) { throw MachineFailure("cannot open the log: " + std::string(error.what())); }
}

int log_rank() { return rank_of_log; }

std::int64_t warnings_logged() { return warnings; }

}  // namespace spindrift::io
