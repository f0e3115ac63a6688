#include "slam/pipeline/options.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace groundloop::slam {
namespace {

using testing::ElementsAre;

/// Visits every option and writes down another value for it that is allowed.
class OtherValues {
 public:
  struct Change {
    std::string key;
    YAML::Node value;
  };
  explicit OtherValues(std::string prefix, std::vector<Change>& changes)
      : prefix_(std::move(prefix)), changes_(changes) {}

  template <class T>
  void operator()(const char* name, T& value, const Field& field = {}) {
    const std::string key = prefix_ + name;
    YAML::Node other;
    if constexpr (Visitable<T>) {
      OtherValues inner(key + ".", changes_);
      value.visit(inner);
      return;
    } else if constexpr (std::is_same_v<T, bool>) {
      other = !value;
    } else if constexpr (std::is_enum_v<T>) {
      for (const auto& [candidate, text] : EnumNames<T>::names) {
        if (candidate != value) other = text;
      }
    } else if constexpr (std::is_integral_v<T>) {
      // 32 more keeps what must be odd, or a multiple of 32
      const double most = std::min(field.max, static_cast<double>(value) + 32);
      other = static_cast<int64_t>(most > static_cast<double>(value) ? most : static_cast<double>(value) - 1);
    } else if constexpr (std::is_floating_point_v<T>) {
      other = value + 0.125 <= field.max ? value + 0.125 : value - 0.125;
    } else {
      for (const auto& item : value) other.push_back(item + 0.125);
    }
    changes_.push_back({key, other});
  }

 private:
  std::string prefix_;
  std::vector<Change>& changes_;
};

std::vector<OtherValues::Change> changes_of(SlamOptions options) {
  std::vector<OtherValues::Change> changes;
  OtherValues visitor("", changes);
  options.visit(visitor);
  return changes;
}

SlamOptions read_back(const std::string& yaml) {
  SlamOptions options;
  std::vector<Problem> problems;
  read_config(YAML::Load(yaml), "test", options, problems);
  EXPECT_THAT(problems, testing::IsEmpty());
  return options;
}

TEST(Presets, AreThePaperAndTheDefault) { EXPECT_THAT(preset_names(), ElementsAre("default", "paper")); }

TEST(Presets, ThePaperWeighsDistancesAndKeepsOneGrid) {
  const SlamOptions paper = preset("paper"), ours = preset("default");
  EXPECT_NE(paper.registration.cost, RegistrationCost::kReprojection);
  EXPECT_EQ(paper.registration.lorentz_scale, 1);
  EXPECT_FALSE(paper.mapping.fuse_layers);
  EXPECT_EQ(ours.registration.cost, RegistrationCost::kReprojection);
  EXPECT_EQ(to_yaml(ours), to_yaml(SlamOptions{}));
}

TEST(Presets, AnUnknownOneIsNamedWithTheKnown) {
  try {
    preset("best");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "slam.preset: best: wanted one of: default, paper");
  }
}

TEST(SlamOptions, RoundTripThroughYaml) {
  for (const std::string& name : preset_names()) {
    const std::string yaml = to_yaml(preset(name));
    EXPECT_EQ(to_yaml(read_back(yaml)), yaml);
  }
}

TEST(SlamOptions, EveryOneCanBeSetByItsDottedKeyAndIsWrittenBack) {
  const std::vector<OtherValues::Change> changes = changes_of({});
  EXPECT_GT(changes.size(), 40u);
  const std::string unchanged = to_yaml(SlamOptions{});
  for (const OtherValues::Change& change : changes) {
    SlamOptions options;
    std::vector<Problem> problems;
    set_by_key(options, change.key, change.value, "--set", 0, problems);
    ASSERT_THAT(problems, testing::IsEmpty()) << change.key << ": " << problems.front().text();
    const std::string yaml = to_yaml(options);
    EXPECT_NE(yaml, unchanged) << change.key;
    EXPECT_EQ(to_yaml(read_back(yaml)), yaml) << change.key;
    // and nothing else has changed
    SlamOptions back = options;
    for (const OtherValues::Change& original : changes) {
      if (original.key != change.key) continue;
      YAML::Node node = YAML::Load(unchanged);
      std::string rest = original.key;
      for (size_t dot = rest.find('.'); dot != std::string::npos; dot = rest.find('.')) {
        node.reset(node[rest.substr(0, dot)]);
        rest = rest.substr(dot + 1);
      }
      set_by_key(back, original.key, node[rest], "--set", 0, problems);
    }
    EXPECT_EQ(to_yaml(back), unchanged) << change.key;
  }
}

std::string complaint(const std::string& key, const std::string& value) {
  SlamOptions options;
  std::vector<Problem> problems;
  set_by_key(options, key, YAML::Node(value), "--set", 0, problems);
  return problems.empty() ? "" : problems.front().text();
}

TEST(SlamOptions, SayWhatIsWrong) {
  EXPECT_EQ(complaint("tracking.max_featurs", "400"),
            "--set: tracking.max_featurs: unknown key: wanted one of: hold_lost_s, max_features, "
            "min_kept_ratio, own_precision, perspective, planned_start_level, start_level "
            "(did you mean max_features?)");
  EXPECT_EQ(complaint("tracking.max_features", "3"),
            "--set: tracking.max_features: 3: wanted a whole number from 20 to 5000");
  EXPECT_EQ(complaint("registration.cost", "huber"),
            "--set: registration.cost: huber: wanted one of: scalar_quadratic, scalar_linear, reprojection");
  EXPECT_EQ(complaint("klt", "4"), "--set: klt: 4: wanted a map of keys and values");
}

}  // namespace
}  // namespace groundloop::slam
