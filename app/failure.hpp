#pragma once
// Whatever was thrown, as an exit code, its name and a message.

#include <exception>
#include <string>

namespace greenwater {

struct Failure {
  int code = 1;
  std::string kind;     ///< of the code: "case error", "numerics failed" ...
  std::string message;  ///< for stderr; begins with a place or with "error:"
};

Failure failure_of(const std::exception_ptr& thrown);

}  // namespace greenwater
