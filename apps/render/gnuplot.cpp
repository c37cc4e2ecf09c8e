#include "render/gnuplot.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "crumble/base/error.hpp"

namespace crumble::render {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

// Files without a name carry script, drawing and messages: with pipes a child that stops early would send us SIGPIPE,
// and two full ones would wait for each other.
File make_file() {
  File file(std::tmpfile());
  if (!file) throw Error(Code::io, std::string("cannot make a temporary file: ") + std::strerror(errno));
  return file;
}

std::string whole(const File& file) {
  std::string text;
  char part[4096];
  std::rewind(file.get());
  for (std::size_t n; (n = std::fread(part, 1, sizeof part, file.get())) > 0;) text.append(part, n);
  return text;
}

// Exit status of gnuplot with these three as its standard input, output and error.
int run(const File& in, const File& out, const File& messages) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(in.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(out.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(messages.get()), STDERR_FILENO);
  char name[] = "gnuplot", no_user_settings[] = "-d";
  char* const arguments[] = {name, no_user_settings, nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, name, &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw Error(Code::unsupported,
                std::string("cannot run gnuplot (Debian package gnuplot-nox): ") + std::strerror(error));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw Error(Code::internal, std::string("lost gnuplot: ") + std::strerror(errno));
  }
  return status;
}

}  // namespace

std::string run_gnuplot(const std::string& script) {
  const File in = make_file(), out = make_file(), messages = make_file();
  if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() || std::fflush(in.get()) != 0) {
    throw Error(Code::io, std::string("cannot write gnuplot's script: ") + std::strerror(errno));
  }
  std::rewind(in.get());
  const int status = run(in, out, messages);
  std::string drawing = whole(out);
  if (status != 0 || drawing.empty()) throw Error(Code::internal, "gnuplot failed: " + whole(messages));
  return drawing;
}

}  // namespace crumble::render
