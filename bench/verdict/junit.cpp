#include "bench/verdict/junit.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <fstream>

namespace groundloop::bench {
namespace {

/// XML 1.0 cannot hold control characters, not even escaped ones.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](unsigned char c) { return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F; }, '?');
  return text;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string details_of(const Verdict& verdict) {
  if (verdict.outcome != Outcome::kFellShort) return verdict.message;
  std::string text;
  for (const Shortfall& missed : verdict.shortfalls) text += (text.empty() ? "" : "\n") + missed.text();
  return text;
}

void attribute(tinyxml2::XMLPrinter& out, const char* name, const std::string& value) {
  out.PushAttribute(name, printable(value).c_str());
}

void write_case(tinyxml2::XMLPrinter& out, const std::string& suite, const JudgedRun& run) {
  out.OpenElement("testcase");
  attribute(out, "name", fmt::format("{} seed {}", run.scenario, run.seed));
  attribute(out, "classname", suite);
  attribute(out, "time", fmt::format("{:.3f}", run.wall_s));
  if (!run.verdict.passed()) {
    out.OpenElement(run.verdict.outcome == Outcome::kFellShort ? "failure" : "error");
    attribute(out, "message", first_line(run.verdict.message));
    attribute(out, "type", name_of(run.verdict.outcome));
    out.PushText(printable(details_of(run.verdict)).c_str());
    out.CloseElement();
  }
  out.CloseElement();
}

}  // namespace

std::string junit_xml(const std::string& suite, const std::vector<JudgedRun>& runs) {
  const auto ended = [&](auto wanted) {
    return std::to_string(std::count_if(runs.begin(), runs.end(),
                                        [&](const JudgedRun& run) { return wanted(run.verdict.outcome); }));
  };
  double wall_s = 0;
  for (const JudgedRun& run : runs) wall_s += run.wall_s;

  tinyxml2::XMLPrinter out;
  out.PushDeclaration("xml version=\"1.0\" encoding=\"UTF-8\"");
  const auto open = [&](const char* element) {
    out.OpenElement(element);
    attribute(out, "name", element == std::string("testsuites") ? "groundloop" : suite);
    attribute(out, "tests", std::to_string(runs.size()));
    attribute(out, "failures", ended([](Outcome o) { return o == Outcome::kFellShort; }));
    attribute(out, "errors", ended([](Outcome o) { return o > Outcome::kFellShort; }));
    attribute(out, "time", fmt::format("{:.3f}", wall_s));
  };
  open("testsuites");
  open("testsuite");
  for (const JudgedRun& run : runs) write_case(out, suite, run);
  out.CloseElement();
  out.CloseElement();
  return out.CStr();
}

void write_junit(const std::string& file, const std::string& suite, const std::vector<JudgedRun>& runs) {
  std::ofstream out(file, std::ios::binary);
  out << junit_xml(suite, runs);
  out.close();
  if (!out) throw InputError(Problem{file, 0, "", "cannot be written", "a file in a writable folder"});
}

}  // namespace groundloop::bench
