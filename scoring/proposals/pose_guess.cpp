#include "scoring/proposals/pose_guess.h"

#include <utility>

namespace rubble::scoring {

std::string names_of(AlignBy methods) {
  std::string out;
  for (const auto& [method, name] : {std::pair{AlignBy::Walls, "walls"},
                                     {AlignBy::Features, "features"},
                                     {AlignBy::Rooms, "rooms"},
                                     {AlignBy::Hand, "given"},
                                     {AlignBy::Equation7, "eq7"},
                                     {AlignBy::Start, "start"}})
    if (includes(methods, method)) out += (out.empty() ? "" : "+") + std::string(name);
  return out;
}

}  // namespace rubble::scoring
