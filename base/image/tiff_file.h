#pragma once

#include <tiffio.h>

#include <memory>
#include <string>

namespace rubble {

/// The first error of libtiff, and the first tag it could not read, instead of its chatter on stderr.
struct TiffComplaint {
  std::string text;
  std::string lost_tag;
};

struct TiffCloser {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffFile = std::unique_ptr<TIFF, TiffCloser>;

/// Opens a TIFF for reading, GeoTIFF tags known to libtiff. Throws InputError: missing, a folder, not a TIFF, tags that
/// lie beyond the end of the file.
/// `complaint` must outlive the file.
TiffFile open_tiff(const std::string& path, TiffComplaint& complaint);

/// A TIFF written into memory.
TiffFile create_tiff(std::string& bytes, TiffComplaint& complaint);

}  // namespace rubble
