// Numbers to and from the program that drives a simulation.

#pragma once

#include <cstdio>
#include <cstdlib>

template <typename Number>
Number get() {
  Number number = 0;
  if (std::fread(&number, sizeof number, 1, stdin) != 1) std::exit(0);
  return number;
}

template <typename Number>
void put(Number number) {
  std::fwrite(&number, sizeof number, 1, stdout);
}
