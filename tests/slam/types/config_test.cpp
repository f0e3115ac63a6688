#include "slam/types/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace groundloop {

enum class Gait { kWalk, kTrot };
template <>
struct EnumNames<Gait> {
  static constexpr std::array<std::pair<Gait, const char*>, 2> names = {
      {{Gait::kWalk, "walk"}, {Gait::kTrot, "trot"}}};
};

namespace {

struct Leg {
  double length_m = 0.5;
  int toes = 4;
  template <class Archive>
  void visit(Archive& a) {
    a("length_m", length_m, {.min = 0.1, .max = 2});
    a("toes", toes, {.min = 1});
  }
  void check(ConfigReader& reader) const {
    if (toes > 4 && length_m < 0.2) reader.problem("toes", "at most 4 on a leg this short");
  }
};

struct Animal {
  std::string name = "nobody";
  bool wild = false;
  Gait gait = Gait::kWalk;
  Leg front;
  std::vector<Leg> legs;
  std::vector<double> spots_m;
  std::map<std::string, double> weights_kg;
  std::optional<double> tail_m;
  template <class Archive>
  void visit(Archive& a) {
    a("name", name, {.required = true});
    a("wild", wild);
    a("gait", gait);
    a("front", front);
    a("legs", legs);
    a("spots_m", spots_m, {.max = 3});
    a("weights_kg", weights_kg);
    a("tail_m", tail_m, {.min = 0});
  }
};

std::vector<std::string> problems_of(const std::string& text, Animal& animal) {
  std::vector<Problem> problems;
  read_config(YAML::Load(text), "zoo.yaml", animal, problems);
  std::vector<std::string> lines;
  for (const Problem& problem : problems) lines.push_back(problem.text());
  return lines;
}
std::vector<std::string> problems_of(const std::string& text) {
  Animal animal;
  return problems_of(text, animal);
}
using Lines = std::vector<std::string>;

TEST(Config, ReadsEveryKindOfValue) {
  Animal animal;
  EXPECT_EQ(problems_of(R"(name: Ida
wild: true
gait: trot
front: {length_m: 1.5, toes: 3}
legs: [{toes: 2}, {length_m: 0.25}]
spots_m: [0.5, -1e-2]
weights_kg: {head: 3, trunk: 20.5}
tail_m: 0.75
)",
                        animal),
            Lines{});
  EXPECT_EQ(animal.name, "Ida");
  EXPECT_TRUE(animal.wild);
  EXPECT_EQ(animal.gait, Gait::kTrot);
  EXPECT_EQ(animal.front.length_m, 1.5);
  EXPECT_EQ(animal.front.toes, 3);
  ASSERT_EQ(animal.legs.size(), 2U);
  EXPECT_EQ(animal.legs[0].toes, 2);
  EXPECT_EQ(animal.legs[0].length_m, 0.5);
  EXPECT_EQ(animal.legs[1].length_m, 0.25);
  EXPECT_EQ(animal.spots_m, (std::vector<double>{0.5, -0.01}));
  EXPECT_EQ(animal.weights_kg, (std::map<std::string, double>{{"head", 3}, {"trunk", 20.5}}));
  EXPECT_EQ(animal.tail_m, 0.75);
}

TEST(Config, MissingKeysKeepTheDefaults) {
  Animal animal;
  EXPECT_EQ(problems_of("name: Ida", animal), Lines{});
  EXPECT_EQ(animal.front.length_m, 0.5);
  EXPECT_FALSE(animal.tail_m);
}

TEST(Config, RequiredKeyIsMissed) {
  EXPECT_EQ(problems_of("wild: true"), Lines{"zoo.yaml:1: name: missing: wanted a text"});
}

TEST(Config, NestedProblemNamesItsWholeKeyAndItsLine) {
  EXPECT_EQ(problems_of("name: Ida\nfront:\n  toes: 3\n  length_m: long\n"),
            Lines{"zoo.yaml:4: front.length_m: long: wanted a number from 0.1 to 2"});
}

TEST(Config, OutOfRangeSaysTheRange) {
  EXPECT_EQ(problems_of("name: Ida\nfront: {length_m: 2.5, toes: 0}\nspots_m: [1, 4]\ntail_m: -1\n"),
            (Lines{"zoo.yaml:2: front.length_m: 2.5: wanted a number from 0.1 to 2",
                   "zoo.yaml:2: front.toes: 0: wanted a whole number of at least 1",
                   "zoo.yaml:3: spots_m[1]: 4: wanted a number of at most 3",
                   "zoo.yaml:4: tail_m: -1: wanted a number of at least 0"}));
  EXPECT_EQ(problems_of("name: Ida\nfront: {length_m: .nan}\n"),
            Lines{"zoo.yaml:2: front.length_m: .nan: wanted a number from 0.1 to 2"});
}

TEST(Config, WrongTypesSayWhatWasWanted) {
  EXPECT_EQ(
      problems_of("name: [Ida]\nwild: perhaps\nfront: {toes: 1.5}\nlegs: two\nweights_kg: [3]\n"),
      (Lines{"zoo.yaml:1: name: [Ida]: wanted a text", "zoo.yaml:2: wild: perhaps: wanted true or false",
             "zoo.yaml:3: front.toes: 1.5: wanted a whole number of at least 1",
             "zoo.yaml:4: legs: two: wanted a list",
             "zoo.yaml:5: weights_kg: [3]: wanted a map of keys and values"}));
}

TEST(Config, ListItemsAreNamedByTheirPlace) {
  EXPECT_EQ(problems_of("name: Ida\nlegs:\n  - {toes: 2}\n  - {toes: many}\n  - five\n"),
            (Lines{"zoo.yaml:4: legs[1].toes: many: wanted a whole number of at least 1",
                   "zoo.yaml:5: legs[2]: five: wanted a map of keys and values"}));
}

TEST(Config, MapEntriesAreNamedByTheirKey) {
  EXPECT_EQ(problems_of("name: Ida\nweights_kg:\n  head: heavy\n"),
            Lines{"zoo.yaml:3: weights_kg.head: heavy: wanted a number"});
}

TEST(Config, EnumSaysItsChoices) {
  EXPECT_EQ(problems_of("name: Ida\ngait: gallop\n"),
            Lines{"zoo.yaml:2: gait: gallop: wanted one of: walk, trot"});
}

TEST(Config, UnknownKeySuggestsTheNearest) {
  EXPECT_EQ(
      problems_of("name: Ida\nfront:\n  lenght_m: 1\n"),
      Lines{
          "zoo.yaml:3: front.lenght_m: unknown key: wanted one of: length_m, toes (did you mean length_m?)"});
}

TEST(Config, UnknownKeyFarFromAllIsNotSuggested) {
  EXPECT_EQ(problems_of("name: Ida\nfront: {claws_per_paw: 1}\n"),
            Lines{"zoo.yaml:2: front.claws_per_paw: unknown key: wanted one of: length_m, toes"});
}

TEST(Config, AllProblemsComeAtOnce) {
  EXPECT_EQ(problems_of("wilt: true\ngait: fly\nfront: {toes: -1}\n").size(), 4U);  // with the missing name
}

TEST(Config, RulesOverSeveralKeysAreChecked) {
  EXPECT_EQ(problems_of("name: Ida\nfront:\n  length_m: 0.15\n  toes: 5\n"),
            Lines{"zoo.yaml:4: front.toes: 5: wanted at most 4 on a leg this short"});
}

TEST(Config, ADocumentThatIsNoMapSaysSo) {
  EXPECT_EQ(problems_of("[1, 2]").at(0), "zoo.yaml:1: [1, 2]: wanted a map of keys and values");
}

TEST(Config, SetByKeyReachesNestedValues) {
  Animal animal;
  std::vector<Problem> problems;
  set_by_key(animal, "front.toes", YAML::Load("2"), "--set", 0, problems);
  EXPECT_TRUE(problems.empty());  // the required name may be missing in an overlay
  EXPECT_EQ(animal.front.toes, 2);
  EXPECT_EQ(animal.front.length_m, 0.5);
}

TEST(Config, SetByKeyReportsItsOrigin) {
  Animal animal;
  std::vector<Problem> problems;
  set_by_key(animal, "front.toez", YAML::Load("2"), "--set", 0, problems);
  set_by_key(animal, "front.toes", YAML::Load("none"), "zoo.yaml", 12, problems);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].text(),
            "--set: front.toez: unknown key: wanted one of: length_m, toes (did you mean toes?)");
  EXPECT_THAT(problems[1].text(), testing::EndsWith("front.toes: none: wanted a whole number of at least 1"));
}

TEST(Config, WhatIsWrittenReadsBackTheSame) {
  Animal animal;
  animal.name = "a: b";
  animal.gait = Gait::kTrot;
  animal.front.length_m = 0.1 + 0.2;
  animal.legs = {{0.3, 1}, {0.7, 2}};
  animal.weights_kg = {{"head", 1.0 / 3}};
  const std::string text = to_yaml(animal);
  Animal read;
  EXPECT_EQ(problems_of(text, read), Lines{});
  EXPECT_EQ(to_yaml(read), text);
  EXPECT_EQ(read.front.length_m, animal.front.length_m);
  EXPECT_EQ(read.weights_kg, animal.weights_kg);
  EXPECT_FALSE(read.tail_m);
}

TEST(Config, FileThatIsMissingOrNoYamlIsNamed) {
  EXPECT_THROW(
      {
        try {
          load_yaml_file("no/such.yaml");
        } catch (const InputError& error) {
          EXPECT_STREQ(error.what(), "no/such.yaml: no such file: wanted a YAML file that can be read");
          throw;
        }
      },
      InputError);
  const auto file = std::filesystem::temp_directory_path() / "groundloop_config_test.yaml";
  std::ofstream(file) << "a: 1\nb: [1, 2\nc: 3\n";
  try {
    load_yaml_file(file.string());
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().at(0).file, file.string());
    EXPECT_EQ(error.problems().at(0).line, 3);
    EXPECT_EQ(error.problems().at(0).wanted, "valid YAML");
  }
  std::filesystem::remove(file);
}

TEST(Config, ErrorShowsEveryProblemOnALineOfItsOwn) {
  const InputError error({{"a.yaml", 1, "x", "1", "2"}, {"b.yaml", 0, "", "missing", ""}});
  EXPECT_STREQ(error.what(), "a.yaml:1: x: 1: wanted 2\nb.yaml: missing");
  EXPECT_EQ(error.problems().size(), 2U);
}

}  // namespace
}  // namespace groundloop
