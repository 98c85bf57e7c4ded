// SPDX-License-Identifier: Apache-2.0
#include "versine/stationing/result.hpp"

namespace versine::stationing {

const char* to_string(Exclusion::Reason reason) {
  switch (reason) {
    case Exclusion::Reason::blunder:
      return "blunder";
    case Exclusion::Reason::moved:
      return "moved control point";
    case Exclusion::Reason::wrong_name:
      return "wrong point number";
    case Exclusion::Reason::unknown_point:
      return "unknown point number";
    case Exclusion::Reason::no_distance:
      return "no distance";
  }
  return "blunder";
}

const char* to_string(GeometryVerdict::Grade grade) {
  switch (grade) {
    case GeometryVerdict::Grade::good:
      return "good";
    case GeometryVerdict::Grade::weak:
      return "weak";
    case GeometryVerdict::Grade::poor:
      return "poor";
  }
  return "poor";
}

}  // namespace versine::stationing
