#include "sim/cache/content_key.h"

#include <gtest/gtest.h>

#include <set>

namespace groundloop::sim {
namespace {

TEST(ContentKey, IsSha256) {
  const KeyBuilder nothing;
  EXPECT_EQ(nothing.key().hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  KeyBuilder abc;  // FIPS 180-2, example B.1
  for (const char letter : {'a', 'b', 'c'}) abc.add(letter);
  EXPECT_EQ(abc.key().hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(ContentKey, NeighboursDoNotRunIntoEachOther) {
  std::set<std::string> keys;
  const auto key_of = [](auto... values) {
    KeyBuilder builder;
    (builder.add(values), ...);
    return builder.key().hex();
  };
  keys.insert(key_of("ab", "c"));
  keys.insert(key_of("a", "bc"));
  keys.insert(key_of("abc"));
  keys.insert(key_of("abc", ""));
  const double one[] = {1, 2};
  KeyBuilder split;
  split.add(one, 1);
  split.add(one + 1, 1);
  keys.insert(split.key().hex());
  KeyBuilder joined;
  joined.add(one, 2);
  keys.insert(joined.key().hex());
  EXPECT_EQ(keys.size(), 6U);
}

TEST(ContentKey, CopiesGoOnFromWhereTheOriginalIs) {
  KeyBuilder run;
  run.add("model");
  KeyBuilder first(run), second(run);
  first.add(1);
  second.add(2);
  KeyBuilder again;
  again.add("model");
  again.add(2);
  EXPECT_EQ(second.key(), again.key());
  EXPECT_EQ(second.key(), second.key());  // asking does not change it
  EXPECT_FALSE(first.key() == second.key());
}

}  // namespace
}  // namespace groundloop::sim
