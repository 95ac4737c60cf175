#pragma once

#include <hoist/data/annotation.h>
#include <hoist/data/prediction.h>

#include <cstddef>
#include <vector>

namespace hoist {

/** \brief How often an attribute of something found is right. */
struct AttributeCount {
  std::size_t truths = 0; ///< found things whose truth is known
  std::size_t said = 0;   ///< of these, the result says it
  std::size_t right = 0;

  void add(const AttributeCount& other);
};

/** \brief Attributes of hits; of what is not found none is judged (as the paper does).
 */
struct Attributes {
  AttributeCount color;    ///< each channel within the tolerance
  AttributeCount material; ///< the same word
  AttributeCount fullness;
  std::vector<double> weight; ///< found / true - 1

  /** \param tolerance of the range 0 ... 255 */
  void
  add(const Prediction& prediction, const AnnotatedObject& truth, double tolerance);

  void add(const Attributes& other);
};

} // namespace hoist
