#pragma once

/// The things that were last of use, up to a total size.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace epafi::fem {

/// The one that was used last comes first. Those that were not used for long are dropped, so that neither a
/// search nor the memory grows with the number of things ever seen.
template <class Thing>
class RecentlyUsed {
public:
  /// \param maxNumber, maxSize  what is kept at most; the newest thing is kept whatever its size
  RecentlyUsed(std::size_t maxNumber, std::size_t maxSize) : maxNumber_(maxNumber), maxSize_(maxSize) {}

  /// The most recent thing that `fits`; null if none does.
  template <class Fits>
  std::shared_ptr<const Thing> find(const Fits& fits) {
    const auto found =
        std::find_if(things_.begin(), things_.end(), [&](const Entry& entry) { return fits(*entry.thing); });
    if (found == things_.end())
      return nullptr;
    std::rotate(things_.begin(), found, found + 1);
    return things_.front().thing;
  }

  std::shared_ptr<const Thing> add(Thing thing, std::size_t size) {
    std::size_t total = size;
    const auto tooMuch = std::find_if(things_.begin(), things_.end(),
                                      [&](const Entry& entry) { return (total += entry.size) > maxSize_; });
    things_.erase(tooMuch, things_.end());
    things_.resize(std::min(things_.size(), maxNumber_ - 1));
    things_.insert(things_.begin(), {std::make_shared<const Thing>(std::move(thing)), size});
    return things_.front().thing;
  }

private:
  struct Entry {
    std::shared_ptr<const Thing> thing;
    std::size_t size = 0;
  };

  std::size_t maxNumber_, maxSize_;
  std::vector<Entry> things_;
};

} // namespace epafi::fem
