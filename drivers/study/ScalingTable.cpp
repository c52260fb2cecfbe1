#include "ScalingTable.hpp"

#include <set>

namespace epafi::drivers {

const std::vector<std::string> scalingSettings{"problem",  "H_inverse",      "H_over_h",  "ranks",
                                               "operator", "preconditioner", "precision", "cluster"};

Table scalingTable() {
  return Table(
      "problem,H_inverse,H_over_h,ranks,operator,preconditioner,hessian_multiplications,assembly_seconds,"
      "setup_seconds,solve_seconds,total_seconds,peak_bytes,apply_seconds,apply_bytes,"
      "stream_bytes_per_second,precision,messages_per_apply,bytes_sent_per_apply,coarse_unknowns,"
      "reductions_per_step,factor_bytes,explicit_setup_seconds,payoff_products,energy,preconditioner_seconds,"
      "preconditioner_bytes,problem_bytes,base_bytes,unknowns,multipliers,reduction_bytes_per_apply,cluster,"
      "reduction_bytes_per_step,team_reductions_per_step,gatherings_per_step",
      10);
}

Row scalingRun(const std::string& problem, int subdomainsPerSide, int elementsPerSide, int ranks) {
  return {{"problem", problem},          {"H_inverse", subdomainsPerSide},
          {"H_over_h", elementsPerSide}, {"ranks", ranks},
          {"operator", "shared"},        {"preconditioner", "dirichlet"},
          {"precision", "double"},       {"cluster", 0}};
}

Table readScaling(const std::filesystem::path& file, int withoutRanks) {
  static const std::set<std::string> words{"problem", "operator", "preconditioner", "precision"};
  const char* const advice = "rows of other numbers of ranks cannot be kept: move it away to start anew";
  Table table = scalingTable();
  const std::vector<std::string> columns = splitLine(table.header());
  for (const Row& read : readCsv(file, columns, advice)) {
    Row row;
    for (const std::string& column : columns)
      if (words.count(column) > 0)
        row[column] = read.text(column);
      else if (!read.text(column).empty())
        row[column] = numberIn(read, column, file, advice);
    if (row.number("ranks") != withoutRanks)
      table.rows.push_back(row);
  }
  return table;
}

} // namespace epafi::drivers
