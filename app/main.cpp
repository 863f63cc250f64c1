// Everything but this is a library, so that tests can link it.
#include "app/options.h"

int main(int argc, char** argv) { return enc::app::command_line(argc, argv); }
