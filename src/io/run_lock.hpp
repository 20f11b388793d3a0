// Who runs in a folder: a file with host, process and a heartbeat, so that two runs never write into one. A lock whose process is
// gone is taken over at once on the same machine; one of another machine when its heartbeat has not moved for a while, which
// needs no common clock. Held by RunDirectory on rank 0; tested in tests/src/io/run_lock_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

namespace spindrift::io {

struct LockTimes {
  std::chrono::milliseconds beat{5000};    ///< between two heartbeats
  std::chrono::milliseconds stale{30000};  ///< without one: the holder is gone
};

class RunLock {
 public:
  static constexpr const char* file_name = "run.lock";

  /// Takes the lock of the folder, which exists. Throws InputError that names the holder where there is a live one. Waits for at
  /// most `times.stale` where the holder is on another computer; throws runtime::StopAsked where it is asked to stop meanwhile.
  explicit RunLock(const std::filesystem::path& folder, LockTimes times = {});
  /// Gives it back.
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

 private:
  void beat();

  std::filesystem::path path_;
  LockTimes times_;
  std::string mine_;  ///< what the file says, but for the heartbeat
  int descriptor_ = -1;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::thread heart_;
};

}  // namespace spindrift::io
