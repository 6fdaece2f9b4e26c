#include "app/failure.hpp"

#include <new>

#include "core/check.hpp"

namespace greenwater {
namespace {

std::string kind_of(int code) {
  switch (code) {
    case 2: return "case error";
    case 3: return "numerics failed";
    case 4: return "file error";
    case 5: return "out of resources";
    default: return "internal error";
  }
}

Failure failure(int code, const std::string& text) {
  const bool placed = text.find(": error: ") != std::string::npos;
  return {code, kind_of(code), placed ? text : "error: " + text};
}

}  // namespace

Failure failure_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    return failure(error.code, error.what());
  } catch (const std::bad_alloc&) {
    return failure(5, "out of memory; take a larger mps.spacing");
  } catch (const std::exception& error) {
    const std::string text = error.what();  // Kokkos reports a failed allocation as a plain runtime_error
    const bool memory = text.find("allocat") != std::string::npos && text.find("emory") != std::string::npos;
    return memory ? failure(5, "out of memory: " + text) : failure(1, "internal: " + text);
  } catch (...) {
    return failure(1, "internal: something unknown was thrown");
  }
}

}  // namespace greenwater
