#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace rubble::scoring {

/// Finds places for words beside points of a picture, so that words cover neither each other nor other points.
class Labels {
 public:
  /// `picture`: its size, which words stay within where they fit.
  explicit Labels(const cv::Size& picture) : picture_(picture) {}

  /// Words for a point that is drawn as large as `radius` [pixels].
  void add(const std::string& words, const cv::Point& at, int radius);
  /// A point without words, not to be covered.
  void keep_free(const cv::Point& at, int radius);

  struct Label {
    std::string words;
    cv::Rect box;  ///< their ground
    cv::Point at;  ///< the point they belong to
    int radius = 0;
    bool far = false;  ///< not beside the point: a line should lead to it
  };
  /// In the order they were added: beside their point where there is room, else above or below, else (nowhere is room)
  /// to its right all the same.
  std::vector<Label> placed() const;

 private:
  cv::Size picture_;
  std::vector<Label> wanted_;
  std::vector<cv::Rect> points_;
};

/// Places and draws them.
void draw_labels(cv::Mat& image, const Labels& labels);

}  // namespace rubble::scoring
