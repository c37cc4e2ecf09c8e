#include "crumble/base/error.hpp"

#include <cmath>

#include "crumble/base/text.hpp"

namespace crumble {

void require_finite(std::string_view field, double value) {
  if (!std::isfinite(value)) {
    throw Error(Code::invalid_value, std::string(field) + " must be finite, is " + to_text(value));
  }
}

void require_positive(std::string_view field, double value) {
  require_finite(field, value);
  if (value <= 0) {
    throw Error(Code::out_of_range, std::string(field) + " must be positive, is " + to_text(value));
  }
}

void require_in_range(std::string_view field, double value, double least, double greatest) {
  require_finite(field, value);
  if (value < least || value > greatest) {
    throw Error(Code::out_of_range, std::string(field) + " must lie in [" + to_text(least) + ", " + to_text(greatest) +
                                        "], is " + to_text(value));
  }
}

}  // namespace crumble
