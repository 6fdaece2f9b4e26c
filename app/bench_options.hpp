#pragma once
// What `bench` was asked to do, and how it is asked. The work itself is in bench/.

#include <string>
#include <vector>

#include "io/case_file.hpp"

namespace CLI {
class App;
}

namespace greenwater {

struct BenchOptions {
  enum class What { states, step, pressure, scaling, fem };
  What what = What::step;
  std::vector<int> sizes;  ///< particles, or elements of `fem`, nearly; empty: the usual ones
  int dimension = 2;
  std::vector<std::string> states;           ///< rest, early, collapse, splash
  std::vector<std::string> plates;           ///< none, plate, barrier
  std::vector<std::string> preconditioners;  ///< empty: all that are meant to be used
  std::vector<std::string> solvers;          ///< names of bench/solvers.cpp
  std::string source = "density";            ///< of the pressure equation
  std::vector<double> tolerances;            ///< relative residuals; several for `pressure` only
  int rounds = 5;                            ///< how often everything is measured, in turn
  int steps = 10;                            ///< of a round
  std::vector<int> threads;                  ///< several for `scaling` only; empty: not said
  std::string json;                          ///< file for the results; empty: none
  std::string cache;                         ///< folder of the states; empty: the usual one
  std::vector<std::string> sets;             ///< KEY=VALUE for the case that is measured
  std::vector<std::string> command_line;     ///< all of it, for the record
};

/// Adds the verb `bench` with its own verbs; they write into `options`, which must outlive the parsing.
void add_bench(CLI::App& app, BenchOptions& options);

}  // namespace greenwater
