#pragma once

/// A file in CalculiX' format as its columns have it.

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace epafi::output {

struct FrdElement {
  int number, type, material;
  std::vector<int> nodes;
};

struct FrdBlock {
  std::string name, step;
  double time;
  int increment, numStep;
  std::size_t numNodes; ///< as its head says
  std::map<int, std::vector<double>> values;
};

/// What a file says, column by column.
struct Frd {
  std::map<int, std::vector<double>> nodes;
  std::vector<FrdElement> elements;
  std::vector<FrdBlock> blocks;
  std::vector<std::string> materials;
  std::size_t numNodes = 0, numElements = 0; ///< as the heads say
  bool isComplete = false;

  explicit Frd(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      read(line);
  }

private:
  void read(const std::string& line) {
    const std::string key = line.substr(0, 3);
    const auto integer = [&](std::size_t from, std::size_t width) {
      return std::stoi(line.substr(from, width));
    };
    if (line.starts_with("    1UMAT"))
      materials.push_back(line.substr(14));
    else if (line.starts_with("    1PSTEP"))
      numStep_ = integer(48, 12);
    else if (line.starts_with("    1PNAME"))
      step_ = line.substr(24);
    else if (line.starts_with("    2C")) {
      numNodes = static_cast<std::size_t>(integer(24, 12));
      values_ = &nodes;
    } else if (line.starts_with("    3C")) {
      numElements = static_cast<std::size_t>(integer(24, 12));
    } else if (line.starts_with("  100CL")) {
      EXPECT_EQ(line.size(), 75U) << line;
      blocks.push_back({"",
                        step_,
                        std::stod(line.substr(12, 12)),
                        integer(58, 5),
                        numStep_,
                        static_cast<std::size_t>(integer(24, 12)),
                        {}});
      step_.clear();
    } else if (key == " -4") {
      blocks.back().name = line.substr(5, line.find(' ', 5) - 5);
      values_ = &blocks.back().values;
    } else if (key == " -1" && values_ != nullptr) {
      std::vector<double>& row = (*values_)[integer(3, 10)];
      EXPECT_TRUE(row.empty()) << "twice: " << line;
      EXPECT_EQ((line.size() - 13) % 12, 0U) << line;
      for (std::size_t column = 13; column < line.size(); column += 12)
        row.push_back(std::stod(line.substr(column, 12)));
    } else if (key == " -1") {
      elements.push_back({integer(3, 10), integer(13, 5), integer(23, 5), {}});
    } else if (key == " -2") {
      for (std::size_t column = 3; column < line.size(); column += 10)
        elements.back().nodes.push_back(integer(column, 10));
    } else if (key == " -3") {
      values_ = nullptr;
    }
    isComplete = line == " 9999";
  }

  std::map<int, std::vector<double>>* values_ = nullptr;
  std::string step_;
  int numStep_ = 0;
};

} // namespace epafi::output
