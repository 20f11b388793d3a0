// SPDX-License-Identifier: Apache-2.0
#include "src/io/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <utility>

#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace fs = std::filesystem;

fs::path temporary_of(const fs::path& path) {
  fs::path temporary = path;
  temporary += ".tmp";
  return temporary;
}

OutputFile::OutputFile(fs::path path, Start start) : path_(std::move(path)) {
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | (start == Start::empty ? O_TRUNC : 0), 0666);
  if (descriptor_ < 0) throw_errno("cannot open", path_, errno);
  ::lseek(descriptor_, 0, SEEK_END);  // not O_APPEND: with it Linux appends what write_at() places
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw_errno("cannot write", path_, errno);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void OutputFile::write_at(long long offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), offset);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw_errno("cannot write", path_, errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += written;
  }
}

void OutputFile::sync() {
  // A pipe or a device (--out /dev/...) cannot be synchronised; that is no failure.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) throw_errno("cannot force to disk", path_, errno);
}

void OutputFile::cut(long long bytes) {
  if (::ftruncate(descriptor_, bytes) != 0) throw_errno("cannot shorten", path_, errno);
  ::lseek(descriptor_, 0, SEEK_END);
}

void commit_file(const fs::path& temporary, const fs::path& path) {
  OutputFile(temporary, OutputFile::Start::end).sync();
  if (::rename(temporary.c_str(), path.c_str()) != 0) throw_errno("cannot rename " + temporary.string() + " to", path, errno);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // the rename holds; only its durability over a power cut is the file system's business
  ::fsync(descriptor);
  ::close(descriptor);
}

void write_atomically(const fs::path& path, std::string_view content) {
  const fs::path temporary = temporary_of(path);
  try {
    OutputFile(temporary, OutputFile::Start::empty).write(content);
    commit_file(temporary, path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw_errno("cannot read", path, errno);
  std::ostringstream text;
  text << in.rdbuf();
  if (in.bad()) throw_errno("cannot read", path, errno);
  return std::move(text).str();
}

}  // namespace spindrift::io
