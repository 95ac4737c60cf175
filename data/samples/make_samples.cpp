// Writes the sample scenes and their truth: hoist_make_samples FOLDER
// The files in data/samples were made by it; a test compares them byte for byte.
#include "sample_files.h"

#include <exception>
#include <iostream>

int
main(int argc, char** argv)
{
  if (argc != 2) {
    std::cerr << "usage: hoist_make_samples FOLDER\n";
    return 2;
  }
  try {
    for (const auto& path : hoist::samples::writeSamples(argv[1]))
      std::cout << path.string() << '\n';
  }
  catch (const std::exception& error) {
    std::cerr << "hoist_make_samples: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
