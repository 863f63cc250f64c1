// All other code is in a library, so that tests can link it.
#include "app/common/options.h"
#include "app/process.h"

int main(int argc, char** argv) {
  enc::app::fill_streams();  // before any file is opened
  return enc::app::command_line(argc, argv);
}
