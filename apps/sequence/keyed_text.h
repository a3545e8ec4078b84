#pragma once

#include <string>
#include <vector>

namespace pellucid::sequence {

/// Text such as "orbit:30,20,4" that is given at some frames. Between them its numbers follow monotone cubics (F. N. Fritsch, R. E.
/// Carlson: Monotone Piecewise Cubic Interpolation, 1980), which pass through the keys and never beyond them. Outside they stay.
class KeyedText {
public:
    /// `keys`: "FRAME=KIND:A,B,...", all of one kind with as many numbers. Throws Error naming `what`.
    KeyedText(const std::string& what, const std::vector<std::string>& keys);

    std::string at(long frame) const;
    long last_frame() const { return keys_.back().frame; }

private:
    struct Key {
        long frame = 0;
        std::vector<double> numbers;
        std::vector<double> slopes;  ///< per frame
    };
    void find_slopes();

    std::string kind_;
    std::vector<Key> keys_;  ///< by frame
};

}  // namespace pellucid::sequence
