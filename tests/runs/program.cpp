#include "tests/runs/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>

namespace groundloop::bench {
namespace fs = std::filesystem;
namespace {

pid_t start(const std::vector<std::string>& arguments, const std::string& out, const std::string& err) {
  std::vector<char*> argv;
  std::string program = GROUNDLOOP_PROGRAM;
  argv.push_back(program.data());
  std::vector<std::string> copies = arguments;
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const int o = open(out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    const int e = open(err.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    const int i = open("/dev/null", O_RDONLY);
    if (o < 0 || e < 0 || i < 0) _exit(126);
    dup2(i, STDIN_FILENO);
    dup2(o, STDOUT_FILENO);
    dup2(e, STDERR_FILENO);
    setenv("GROUNDLOOP_CACHE", "off", 0);  // what is tested is made anew
    execv(argv[0], argv.data());
    _exit(127);
  }
  return child;
}

Answer run(const std::vector<std::string>& arguments, int signal) {
  const fs::path folder = fs::temp_directory_path();
  const std::string out = (folder / "program_out").string(), err = (folder / "program_err").string();
  std::ofstream(err).close();
  const pid_t child = start(arguments, out, err);
  int status = 0;
  if (signal != 0) {
    while (text_of(err).find("pairs") == std::string::npos && waitpid(child, &status, WNOHANG) == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    kill(child, signal);
  }
  waitpid(child, &status, 0);
  Answer answer;
  answer.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  answer.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  answer.out = text_of(out);
  answer.err = text_of(err);
  return answer;
}

}  // namespace

std::string Answer::complaint() const {
  std::istringstream in(err);
  std::string text, line;
  while (std::getline(in, line)) {
    if (line.find(" pairs") != std::string::npos || line.find(", profile ") != std::string::npos) continue;
    text += (text.empty() ? "" : "\n") + line;
  }
  return text;
}

Answer groundloop(const std::vector<std::string>& arguments) { return run(arguments, 0); }
Answer groundloop_with_signal(const std::vector<std::string>& arguments, int signal) {
  return run(arguments, signal);
}

Workspace::Workspace() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  path_ = fs::temp_directory_path() / (std::string(info->test_suite_name()) + "_" + info->name());
  fs::remove_all(path_);
  fs::create_directories(path_);
}

Workspace::~Workspace() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string Workspace::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
  return path(name);
}

std::vector<std::string> Workspace::entries(const std::string& folder) const {
  std::vector<std::string> names;
  const fs::path root = path_ / folder;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    names.push_back(entry.path().lexically_relative(root).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace groundloop::bench
