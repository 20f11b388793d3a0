// SPDX-License-Identifier: Apache-2.0
#include "src/io/xdmf_series.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <string>

namespace spindrift::io {

namespace {

constexpr std::string_view opening =
    "<?xml version=\"1.0\"?>\n"
    "<Xdmf Version=\"2.2\"><Domain>\n"
    "<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
constexpr std::string_view closing = "</Grid>\n</Domain></Xdmf>\n";
constexpr std::string_view entry_mark = "<!-- time_s=";

/// Where the first entry later than `last_s` begins, or the closing lines.
std::size_t end_of_kept(const std::string& text, double last_s) {
  std::size_t at = 0;
  while ((at = text.find(entry_mark, at)) != std::string::npos) {
    const double time = std::strtod(text.c_str() + at + entry_mark.size(), nullptr);
    if (time > last_s) return at;
    at += entry_mark.size();
  }
  return text.rfind(closing);
}

}  // namespace

XdmfSeries::XdmfSeries(const std::filesystem::path& path, std::string_view name, double resume_s) {
  std::string text = fmt::format(fmt::runtime(opening), name);
  if (std::filesystem::exists(path)) {
    const std::string before = read_file(path);
    const std::size_t kept = end_of_kept(before, resume_s);
    if (before.starts_with(text) && kept != std::string::npos) text = before.substr(0, kept);
  }
  if (const std::size_t at = text.rfind(entry_mark); at != std::string::npos)
    last_s_ = std::strtod(text.c_str() + at + entry_mark.size(), nullptr);
  end_ = static_cast<long long>(text.size());
  write_atomically(path, text + std::string(closing));
  file_ = OutputFile(path, OutputFile::Start::end);
}

void XdmfSeries::append(double time_s, std::string_view grid) {
  const std::string entry = fmt::format("{}{} -->\n{}", entry_mark, time_s, grid);
  const std::string text = entry + std::string(closing);
  file_.write_at(end_, std::as_bytes(std::span(text)));
  end_ += static_cast<long long>(entry.size());
  last_s_ = time_s;
}

}  // namespace spindrift::io
