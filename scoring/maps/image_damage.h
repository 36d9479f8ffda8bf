#pragma once

#include <string>

namespace rubble::scoring {

/// The file is a PNG or JPEG that ends before its last chunk (IEND) or marker (EOI). What follows that does not matter.
/// Decoders fill in what is missing and say so on stderr only.
bool is_cut_short(const std::string& path);

/// Keeps what libraries print on stderr while it lives, so that a bad file is one line in our own words.
/// Not for threads that print meanwhile.
class StderrCapture {
 public:
  StderrCapture();
  ~StderrCapture();
  StderrCapture(const StderrCapture&) = delete;
  StderrCapture& operator=(const StderrCapture&) = delete;
  /// All that was printed so far.
  std::string text() const;

 private:
  int stderr_ = -1;  ///< the real one; -1: nothing is captured
  int file_ = -1;
};

/// What a decoder printed says that pixels are lost or made up; remarks on profiles and the like do not.
bool tells_of_damage(const std::string& printed);

}  // namespace rubble::scoring
