// SPDX-License-Identifier: BSD-3-Clause
// Runs a fuzz target without libFuzzer: its stored corpus, then a fixed number of mutations of it, the same each time.
//   TARGET CORPUS [ROUNDS]         default: 0 rounds; CORPUS is a folder, or one file to look at again
//   TARGET --random FIRST ROUNDS   random bytes instead, of seeds from FIRST on; says every thousand how far it is
// A failing input is kept as finding.bin in the working folder.
#include "random_input.h"
#include "target.h"

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Input = std::vector<std::uint8_t>;

constexpr auto kept = "finding.bin";

Input current; ///< what the target is running on

void keepCurrent()
{
  std::ofstream(kept, std::ios::binary)
      .write(reinterpret_cast<const char*>(current.data()), static_cast<std::streamsize>(current.size()));
}

/// A crash: the process is lost, but not what caused it.
void onCrash(int signal)
{
  keepCurrent();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::vector<Input> readCorpus(const fs::path& path)
{
  std::vector<fs::path> files;
  if (fs::is_directory(path)) {
    for (const auto& entry : fs::directory_iterator(path)) files.push_back(entry.path());
  }
  else {
    files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  std::vector<Input> corpus;
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw std::runtime_error(file.string() + ": cannot be read: check its name and permissions");
    corpus.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  if (corpus.empty()) throw std::runtime_error(path.string() + ": holds no file: give the folder of a corpus");
  return corpus;
}

/// One to four changes: a bit, a byte, a telling number, a piece of another input, a cut.
class Mutator {
public:
  explicit Mutator(const std::vector<Input>& corpus) : corpus_(corpus) {}

  Input next()
  {
    Input input = pick();
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) change(input);
    return input;
  }

private:
  std::size_t below(std::size_t limit) { return random_() % limit; }

  const Input& pick() { return corpus_[below(corpus_.size())]; }

  void change(Input& input)
  {
    if (input.empty()) input.push_back(0);
    const std::size_t at = below(input.size());
    const auto here = input.begin() + static_cast<std::ptrdiff_t>(at);
    switch (below(6)) {
    case 0:
      *here ^= static_cast<std::uint8_t>(1U << below(8));
      break;
    case 1:
      *here = static_cast<std::uint8_t>(random_());
      break;
    case 2: {
      static constexpr std::string_view words[] = {"0",   "-1",    "4294967295", "18446744073709551615",
                                                   "nan", "1e308", "\n"};
      const std::string_view word = words[below(std::size(words))];
      input.insert(here, word.begin(), word.end());
      break;
    }
    case 3: {
      static constexpr std::uint32_t numbers[] = {0, 1, 0x7fffffff, 0xffffffff, 0x7f800000, 0x7fc00000, 0x00000001};
      const std::uint32_t number = numbers[below(std::size(numbers))];
      std::memcpy(input.data() + at, &number, std::min(sizeof number, input.size() - at));
      break;
    }
    case 4: {
      const Input& other = pick();
      const std::size_t from = below(other.size() + 1);
      input.resize(at);
      input.insert(input.end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
      break;
    }
    default:
      input.resize(at);
    }
  }

  const std::vector<Input>& corpus_;
  std::mt19937 random_{1};
};

bool passes(const Input& input, const std::string& name)
{
  current = input;
  try {
    LLVMFuzzerTestOneInput(current.data(), current.size());
    return true;
  }
  catch (const std::exception& error) {
    keepCurrent();
    std::cerr << name << ": " << error.what() << "; kept as " << fs::absolute(kept).string() << '\n';
    return false;
  }
}

int replay(const fs::path& path, std::size_t rounds)
{
  const std::vector<Input> corpus = readCorpus(path);
  for (std::size_t i = 0; i < corpus.size(); ++i)
    if (!passes(corpus[i], "file " + std::to_string(i) + " of the corpus")) return 1;
  Mutator mutator(corpus);
  for (std::size_t i = 0; i < rounds; ++i)
    if (!passes(mutator.next(), "mutation " + std::to_string(i))) return 1;
  std::cout << corpus.size() << " files and " << rounds << " mutations, no finding\n";
  return 0;
}

int tryRandom(std::uint32_t first, std::size_t rounds)
{
  for (std::size_t i = 0; i < rounds; ++i) {
    const std::uint32_t seed = first + static_cast<std::uint32_t>(i);
    if (!passes(pcl_bsh::fuzz::randomInput(seed), "random input " + std::to_string(seed))) return 1;
    if ((i + 1) % 1000 == 0) std::cout << i + 1 << " random inputs, no finding" << std::endl;
  }
  return 0;
}

template <class Number>
Number numberOf(const char* text)
{
  Number number = 0;
  std::from_chars(text, text + std::strlen(text), number);
  return number;
}

} // namespace

int main(int argc, char** argv)
{
  const bool random = argc == 4 && std::strcmp(argv[1], "--random") == 0;
  if (!random && (argc < 2 || argc > 3)) {
    std::cerr << argv[0] << ": command line: CORPUS [ROUNDS] or --random FIRST ROUNDS is expected\n";
    return 2;
  }
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE}) std::signal(signal, onCrash);
  try {
    if (random) return tryRandom(numberOf<std::uint32_t>(argv[2]), numberOf<std::size_t>(argv[3]));
    return replay(argv[1], argc == 3 ? numberOf<std::size_t>(argv[2]) : 0);
  }
  catch (const std::exception& error) {
    std::cerr << argv[0] << ": " << error.what() << '\n';
    return 1;
  }
}
