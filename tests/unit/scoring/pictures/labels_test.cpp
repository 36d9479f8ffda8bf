#include "scoring/pictures/labels.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace rubble::scoring {
namespace {

const cv::Size kPicture(400, 300);
constexpr int kRadius = 9;

cv::Rect around(const cv::Point& at) { return {at.x - kRadius, at.y - kRadius, 2 * kRadius + 1, 2 * kRadius + 1}; }

std::vector<Labels::Label> placed(const std::vector<cv::Point>& points) {
  Labels labels(kPicture);
  for (std::size_t i = 0; i < points.size(); ++i)
    labels.add("victim " + std::to_string(i) + " = true victim" + std::to_string(i), points[i], kRadius);
  return labels.placed();
}

void expect_apart(const std::vector<cv::Point>& points) {
  const std::vector<Labels::Label> labels = placed(points);
  ASSERT_EQ(labels.size(), points.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_EQ(labels[i].box & cv::Rect({}, kPicture), labels[i].box) << "inside the picture";
    for (std::size_t j = 0; j < labels.size(); ++j) {
      EXPECT_TRUE((labels[i].box & around(points[j])).empty()) << i << " covers the point " << j;
      EXPECT_TRUE(i == j || (labels[i].box & labels[j].box).empty()) << i << " covers the words of " << j;
    }
  }
}

TEST(Labels, OfPointsFarApartStandBesideThem) {
  for (const Labels::Label& label : placed({{50, 50}, {60, 200}})) {
    EXPECT_GT(label.box.x, label.at.x);
    EXPECT_LT(label.box.x, label.at.x + 15);
    EXPECT_FALSE(label.far);
  }
}

TEST(Labels, OfCloseVictimsCoverNeitherEachOtherNorAVictim) {
  expect_apart({{100, 100}, {110, 104}});
  expect_apart({{100, 100}, {120, 100}, {140, 100}, {160, 100}});
  expect_apart({{100, 100}, {100, 100}, {100, 100}, {100, 100}, {100, 100}, {100, 100}});
}

TEST(Labels, AtTheRimStayInThePicture) { expect_apart({{395, 5}, {390, 12}, {2, 297}, {9, 290}, {396, 296}}); }

TEST(Labels, WithoutRoomStandThereAllTheSame) {
  Labels labels({30, 20});
  labels.add("a name longer than the picture", {15, 10}, kRadius);
  EXPECT_EQ(labels.placed().size(), 1u);
}

}  // namespace
}  // namespace rubble::scoring
