// Pictures of maps: PNG, JPEG, BMP, PNM.
#include "fuzz/harness.h"
#include "scoring/maps/image_header.h"

RUBBLE_FUZZ_TARGET {
  rubble::scoring::image_header(rubble::fuzz::text_of(data, size));
  return 0;
}
