#include "scoring/maps/image_codecs.h"

#include "base/module.h"

namespace rubble::scoring {

const ImageCodecs& image_codecs() {
  static const ImageCodecs& module = *reinterpret_cast<ImageCodecsFunction>(
      module_function("reading images", "rubble_image_codecs.so", kImageCodecsSymbol,
                      "install libopencv-dev and build again, or give maps as GeoTIFF"))();
  return module;
}

}  // namespace rubble::scoring
