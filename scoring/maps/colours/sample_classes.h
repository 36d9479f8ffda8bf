#pragma once

#include "base/image/rich_tiff.h"
#include "scoring/maps/colours/grey_levels.h"

namespace rubble::scoring {

/// Classes of samples that are no colours (notes.are_measured()): P(occupied) or per cent, or a few labels. What labels
/// stand for, and whether the file holds P(free) instead, is told by shape and place: walls are thin lines with free
/// ground on both sides, unknown ground lies along the rim. Where these say nothing, samples mean what they usually do.
LabelImage classify_samples(const RgbImage& image, const SampleNotes& notes);

}  // namespace rubble::scoring
