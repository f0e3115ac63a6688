#include "sim/simulation/state_pool.h"

namespace groundloop::sim {

std::shared_ptr<mjData> StatePool::copy(const mjData& state) {
  World::DataPtr copy(nullptr, mj_deleteData);
  {
    const std::lock_guard lock(shelf_->mutex);
    if (!shelf_->unused.empty()) {
      copy = std::move(shelf_->unused.back());
      shelf_->unused.pop_back();
    }
  }
  if (!copy) copy.reset(mj_makeData(&model_));
  mj_copyData(copy.get(), &model_, &state);
  return {copy.release(), [shelf = shelf_](mjData* data) {
            const std::lock_guard lock(shelf->mutex);
            shelf->unused.emplace_back(data, mj_deleteData);
          }};
}

}  // namespace groundloop::sim
