#include "scoring/marks.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scoring/maps/pois.h"

namespace rubble::scoring {
namespace {

/// The truth's numbers are not those of the reports.
TEST(VictimNames, ATrueVictimIsToldFromTheReportThatIsIt) {
  const std::vector<Poi> reported = {{"victim 1", {5.0, 5.0}}, {"victim 2", {1.0, 1.1}}};
  const std::vector<Poi> there = {{"victim1", {1.0, 1.0}}, {"hall", {9.0, 9.0}}};
  const Marks marks = marks_of(reported, there, {});
  ASSERT_EQ(marks.pairs.size(), 1u);
  EXPECT_EQ(joined_name(marks.pairs[0].first, marks.pairs[0].second), "victim 2 = true victim1");
  ASSERT_EQ(marks.map_only.size(), 1u);
  EXPECT_EQ(marks.map_only[0].name, "victim 1");
  ASSERT_EQ(marks.truth_only.size(), 1u);
  EXPECT_EQ(marks.truth_only[0].name, "true victim hall");
  EXPECT_EQ(joined_name({}, marks.truth_only[0]), "true victim hall");
}

TEST(VictimNames, TheListOfARunNamesItsVictimsWithoutBlanks) {
  const std::string path = (std::filesystem::temp_directory_path() / "rubble-victim-names.csv").string();
  std::ofstream(path) << "\"pois\"\ndetection,time,type,name,x,y,z,robot,mode\n"
                         "1,00:00:01,victim,victim_12,1.0,2.0,0.0,r,A\n2,00:00:02,victim,victim_b,1.0,2.0,0.0,r,A\n";
  const PoiList list = read_poi_list(path);
  std::filesystem::remove(path);
  ASSERT_EQ(list.pois.size(), 2u);
  EXPECT_EQ(list.pois[0].name, "victim 12");
  EXPECT_EQ(list.pois[1].name, "victim_b") << "another team's own name";
}

}  // namespace
}  // namespace rubble::scoring
