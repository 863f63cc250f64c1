#include <fstream>

#include <fmt/format.h>

#include "app/options.h"
#include "benchmarks/response_source.h"
#include "core/error.h"

namespace enc::app {

int response(const ResponseOptions& options) {
  const std::string text = bench::plant_response_text({}, 4e-3, 6e-3, LoopModel{});
  if (options.out.empty()) {
    fmt::print("{}", text);
    return 0;
  }
  std::ofstream file(options.out, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw Error(options.out + ": cannot be written; choose a folder that exists and is yours");
  return 0;
}

}  // namespace enc::app
