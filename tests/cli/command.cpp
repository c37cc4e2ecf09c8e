#include "cli/command.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"

namespace crumble::cli {
namespace {

void redirect(const std::filesystem::path& path, int descriptor) {
  ::dup2(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), descriptor);
}

}  // namespace

Outcome crumble(const Vector<std::string>& arguments, const std::filesystem::path& folder) {
  static int count = 0;
  const std::filesystem::path base = std::filesystem::temp_directory_path() /
                                     ("crumble-cli-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
  const std::filesystem::path out = base.string() + ".out", err = base.string() + ".err";
  Vector<std::string> words{CRUMBLE_CLI};
  words.insert(words.end(), arguments.begin(), arguments.end());
  Vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = ::fork();
  if (child == 0) {
    redirect(out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    if (::chdir(folder.c_str()) == 0) ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  const Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(out),
                        read_text(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return outcome;
}

}  // namespace crumble::cli
