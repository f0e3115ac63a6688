#include "bench/verdict/junit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include "tests/bench/metrics/test_folder.h"

namespace groundloop::bench {
namespace {

using testing::HasSubstr;
using tinyxml2::XMLElement;

std::vector<JudgedRun> four_runs() {
  const Metrics tracked = {{"trajectory.lost_frames", 0}, {"map.f1", 0.5}};
  sim::Expectations strict;
  strict.metrics = {{"map.f1", {0.6, {}}}, {"map.iou", {0.4, {}}}};
  return {{"lab_p3dx", 1, 12.5, judge({}, tracked)},
          {"lab_p3dx", 2, 13.25, judge(strict, tracked)},
          {"office", 1, 0,
           bad_input(InputError({{"a.yaml", 1, "x", "<y> & \"z\"", "w"}, {"a.yaml", 2, "k", "", ""}}))},
          {"office", 2, 1, internal_error("bad \x01 bytes")}};
}

class Junit : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(document_.Parse(junit_xml("nightly", four_runs()).c_str()), tinyxml2::XML_SUCCESS);
    suites_ = document_.FirstChildElement("testsuites");
    ASSERT_NE(suites_, nullptr);
    suite_ = suites_->FirstChildElement("testsuite");
    ASSERT_NE(suite_, nullptr);
    for (auto* c = suite_->FirstChildElement("testcase"); c; c = c->NextSiblingElement("testcase"))
      cases_.push_back(c);
    ASSERT_EQ(cases_.size(), 4u);
  }

  tinyxml2::XMLDocument document_;
  XMLElement* suites_ = nullptr;
  XMLElement* suite_ = nullptr;
  std::vector<XMLElement*> cases_;
};

TEST_F(Junit, CountsTestsFailuresAndErrors) {
  for (const XMLElement* element : {suites_, suite_}) {
    EXPECT_EQ(element->IntAttribute("tests"), 4);
    EXPECT_EQ(element->IntAttribute("failures"), 1);
    EXPECT_EQ(element->IntAttribute("errors"), 2);
    EXPECT_DOUBLE_EQ(element->DoubleAttribute("time"), 26.75);
  }
  EXPECT_STREQ(suite_->Attribute("name"), "nightly");
  EXPECT_EQ(suite_->NextSiblingElement(), nullptr);
}

TEST_F(Junit, NamesEveryRun) {
  EXPECT_STREQ(cases_[0]->Attribute("name"), "lab_p3dx seed 1");
  EXPECT_STREQ(cases_[1]->Attribute("name"), "lab_p3dx seed 2");
  EXPECT_STREQ(cases_[0]->Attribute("classname"), "nightly");
  EXPECT_STREQ(cases_[1]->Attribute("time"), "13.250");
}

TEST_F(Junit, APassHasNoChild) { EXPECT_EQ(cases_[0]->FirstChildElement(), nullptr); }

TEST_F(Junit, AShortfallIsAFailureWithItsReasons) {
  const XMLElement* failure = cases_[1]->FirstChildElement();
  ASSERT_STREQ(failure->Name(), "failure");
  EXPECT_STREQ(failure->Attribute("type"), "fell short");
  EXPECT_STREQ(failure->Attribute("message"),
               "map.f1 is 0.5, expected at least 0.6; map.iou was not measured, expected at least 0.4");
  EXPECT_STREQ(failure->GetText(),
               "map.f1 is 0.5, expected at least 0.6\nmap.iou was not measured, expected at least 0.4");
}

TEST_F(Junit, BadInputIsAnErrorWithEveryProblem) {
  const XMLElement* error = cases_[2]->FirstChildElement();
  ASSERT_STREQ(error->Name(), "error");
  EXPECT_STREQ(error->Attribute("type"), "bad input");
  EXPECT_STREQ(error->Attribute("message"), "a.yaml:1: x: <y> & \"z\": wanted w");
  EXPECT_STREQ(error->GetText(), "a.yaml:1: x: <y> & \"z\": wanted w\na.yaml:2: k");
}

TEST_F(Junit, ControlCharactersAreReplaced) {
  EXPECT_STREQ(cases_[3]->FirstChildElement("error")->GetText(), "bad ? bytes");
  EXPECT_EQ(junit_xml("s", four_runs()).find('\x01'), std::string::npos);
}

TEST(JunitFile, IsWrittenWithItsHeader) {
  const TestFolder folder;
  write_junit(folder.path("out.xml"), "s", four_runs());
  EXPECT_EQ(text_of(folder.path("out.xml")), junit_xml("s", four_runs()));
  EXPECT_THAT(text_of(folder.path("out.xml")),
              testing::StartsWith("<?xml version=\"1.0\" encoding=\"UTF-8\"?>"));
}

TEST(JunitFile, SaysWhenItCannotBeWritten) {
  try {
    write_junit("no/such/folder/out.xml", "s", {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "no/such/folder/out.xml: cannot be written: wanted a file in a writable folder");
  }
}

}  // namespace
}  // namespace groundloop::bench
