#include "epafi/base/Index.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <type_traits>
#include <vector>

namespace epafi {
namespace {

using Row = Index<struct RowSpace>;
using Column = Index<struct ColumnSpace>;

template <class A, class B>
concept Comparable = requires(A a, B b) {
  a == b;
};
template <class A, class B>
concept Ordered = requires(A a, B b) {
  a < b;
};

TEST(IndexTest, TakesNoNumberOfAnotherSpace) {
  static_assert(std::is_convertible_v<int, Row> && std::is_convertible_v<Row, int>);
  static_assert(!std::is_convertible_v<Column, Row> && !std::is_constructible_v<Row, Column> &&
                !std::is_assignable_v<Row&, Column>);
  static_assert(Comparable<Row, Row> && Comparable<Row, int> && !Comparable<Row, Column>);
  static_assert(Ordered<Row, Row> && !Ordered<Row, Column>);
  static_assert(std::is_trivially_copyable_v<Row> && sizeof(Row) == sizeof(int)); // travels in messages
}

TEST(IndexTest, ReadsAsItsInteger) {
  const std::vector<double> values{1, 2, 3};
  const Row row = 2;
  EXPECT_EQ(values[row], 3);
  EXPECT_EQ(row, 2);
  EXPECT_LT(Row(1), row);
  EXPECT_EQ(Row(), 0);
}

} // namespace
} // namespace epafi
