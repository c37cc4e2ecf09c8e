// Stands in for inverse3.cpp where what that needs is not there.
#include "crumble/base/error.hpp"
#include "crumble/device/inverse3.hpp"

namespace crumble {

std::unique_ptr<Inverse3> open_inverse3(const Inverse3Options&) {
  throw Error(Code::unsupported,
              "device kind inverse3 cannot be opened: this build was made without " CRUMBLE_INVERSE3_LACKS);
}

}  // namespace crumble
