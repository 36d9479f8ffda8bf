#include "base/yaml/kinds.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"

namespace rubble {
namespace {

/// Animals, which come in kinds: each has a size under a key of its own.
class Animal {
 public:
  virtual ~Animal() = default;
  virtual void bind(Binder& binder) = 0;
  virtual double size() const = 0;
  virtual std::unique_ptr<Animal> copy() const = 0;
};

struct CatConfig {
  double whiskers = 0.1;
};
void bind(Binder& binder, CatConfig& config) { binder.number("whiskers_m", config.whiskers, 0.0, 1.0); }

struct WormConfig {
  double length = 0.2;
};
void bind(Binder& binder, WormConfig& config) { binder.number("length_m", config.length, 0.0, 10.0); }

class Cat : public ParametersIn<Animal, CatConfig> {
 public:
  double size() const override { return config.whiskers; }
  std::unique_ptr<Animal> copy() const override { return std::make_unique<Cat>(*this); }
};

class Worm : public ParametersIn<Animal, WormConfig> {
 public:
  double size() const override { return config.length; }
  std::unique_ptr<Animal> copy() const override { return std::make_unique<Worm>(*this); }
};

const std::vector<Kind<Animal>>& animals() {
  static const std::vector<Kind<Animal>> table = {{"cat", "purrs", [] { return std::make_unique<Cat>(); }},
                                                  {"worm", "digs", [] { return std::make_unique<Worm>(); }}};
  return table;
}

class AnimalConfig : public KindChoice<Animal> {
 public:
  AnimalConfig() : KindChoice("animal", animals()) {}
  double size() const { return parameters().size(); }
};

AnimalConfig read(const std::string& yaml) {
  AnimalConfig config;
  const YamlMap map = YamlMap::parse(yaml, "zoo.yaml");
  YamlReader reader(map);
  config.bind(reader);
  map.finish();
  return config;
}

std::string refusal(const std::string& yaml) {
  try {
    read(yaml);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Kinds, TheFirstRowIsTheDefault) {
  EXPECT_EQ(AnimalConfig().kind(), "cat");
  EXPECT_EQ(AnimalConfig().size(), 0.1);
}

TEST(Kinds, AFileChoosesTheKindAndThenItsKeys) {
  const AnimalConfig worm = read("{length_m: 3, kind: worm}\n");
  EXPECT_EQ(worm.kind(), "worm");
  EXPECT_EQ(worm.size(), 3.0);
}

TEST(Kinds, KeysOfAnotherKindAreRefused) {
  EXPECT_NE(refusal("{kind: worm, whiskers_m: 0.2}\n").find("whiskers_m"), std::string::npos);
  EXPECT_EQ(refusal("{kind: cat, whiskers_m: 0.2}\n"), "");
}

TEST(Kinds, AnUnknownKindIsToldWithThoseThereAre) {
  AnimalConfig config;
  try {
    config.choose("dragon");
    FAIL() << "dragons are not in the table";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "animal.kind: 'dragon' is no animal; known are cat, worm");
  }
  EXPECT_EQ(config.kind(), "cat");
}

TEST(Kinds, CopiesAreIndependent) {
  AnimalConfig first = read("{kind: worm, length_m: 3}\n");
  AnimalConfig second = first;
  first.choose("cat");
  EXPECT_EQ(second.kind(), "worm");
  EXPECT_EQ(second.size(), 3.0);
  first = second;
  second = AnimalConfig();
  EXPECT_EQ(first.size(), 3.0);
}

TEST(Kinds, WhatIsWrittenIsReadBack) {
  AnimalConfig worm = read("{kind: worm, length_m: 0.3}\n");
  YamlWriter writer;
  worm.bind(writer);
  const AnimalConfig back = read(writer.yaml());
  EXPECT_EQ(back.kind(), "worm");
  EXPECT_EQ(back.size(), 0.3);
}

}  // namespace
}  // namespace rubble
