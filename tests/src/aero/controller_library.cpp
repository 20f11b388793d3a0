// A small controller library of our own with Bladed's interface, for tests: a generator that holds K omega^2 of a filtered speed,
// which it keeps to itself, and what its input file asks for besides: a word and a number a line. SPDX-License-Identifier:
// Apache-2.0
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <string>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace {

struct Settings {
  std::map<std::string, double> number;
  std::string log;
  double at(const std::string& word, double otherwise) const {
    const auto it = number.find(word);
    return it == number.end() ? otherwise : it->second;
  }
};

Settings read(const char* path) {
  Settings settings;
  std::ifstream file(path);
  for (std::string word; file >> word;)
    if (word == "log")
      file >> settings.log;
    else
      file >> settings.number[word];
  return settings;
}

// State that nobody outside can see.
Settings settings;
float filtered = 0.0f;
int calls = 0;

}  // namespace

extern "C" void DISCON(float* swap, int* fail, char* input, char* output, char* message) {
  const auto record = [swap](int number) -> float& { return swap[number - 1]; };
  const int status = int(std::lround(record(1)));
  if (status == 0) settings = read(input), filtered = record(20), calls = 0;
  ++calls;
  if (!settings.log.empty()) std::ofstream(settings.log, std::ios::app) << status << " " << record(2) << " " << output << "\n";
#if defined(__x86_64__)
  _mm_setcsr(_mm_getcsr() | 0x8040);  // as a library built with unsafe mathematics does
#endif
  if (status < 0) return;
  const float share = 1.0f - std::exp(-record(3) / 0.5f);
  filtered += share * (record(20) - filtered);
  const auto asked = [&](const char* word, int number, double otherwise) {
    record(number) = float(record(2) >= settings.at("from", 0.0) ? settings.at(word, otherwise) : otherwise);
  };
  record(45) = float(settings.at("pitch", 0.0));
  for (int b = 0; b < 3; ++b) record(42 + b) = float(settings.at("pitch", 0.0) + 0.01 * b);
  record(47) = float(settings.at("gain", 0.0)) * filtered * filtered;
  asked("contactor", 35, 1.0), asked("brake", 36, 0.0), asked("brake_torque", 107, 0.0), asked("yaw_rate", 48, 0.0);
  asked("pitch_override", 55, 0.0), asked("torque_override", 56, 0.0);
  if (settings.at("not_finite", 0.0) != 0.0) record(47) = std::numeric_limits<float>::quiet_NaN();
  if (settings.at("echo", 0.0) != 0.0) {  // all that it was told, each by its place
    record(47) = 0.0f;
    for (int number : {2, 3, 4, 11, 14, 15, 20, 21, 23, 24, 27, 33, 34, 53, 54, 60, 82, 83, 84, 109})
      record(47) += float(number) * record(number);
    record(45) = record(17) + 100.0f * record(61) + 1000.0f * record(28);
  }
  if (record(2) >= settings.at("leave_from", 1e9)) static_cast<void>(chdir("/"));
  if (record(2) >= settings.at("exit_from", 1e9)) std::exit(0);
  if (record(2) >= settings.at("warn_from", 1e9)) *fail = 1, std::strncpy(message, "speed is high", std::size_t(record(49)) - 1);
  if (record(2) >= settings.at("fail_from", 1e9))
    *fail = -1, std::strncpy(message, "pitch bearing is lost  ", std::size_t(record(49)) - 1);
}
