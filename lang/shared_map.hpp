// A sorted map of which copies share what they have in common.
//
// Where virtual machines may part, the compiler keeps what labels mean, lowers one branch, goes back and
// lowers the other, and merges the two. With ordinary maps each condition would cost as much as the program
// has labels. Here a copy costs nothing, a change costs the path to it, and a merge looks only at what the
// branches changed.
//
// A treap (Seidel and Aragon, "Randomized Search Trees", Algorithmica 16, 1996) whose nodes never change: an
// insertion makes new nodes along its path and keeps the others (Driscoll et al., "Making Data Structures
// Persistent", JCSS 38, 1989).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace abbe::lang {

template <class Key, class Value>
class SharedMap {
 public:
  /// nullptr when there is no such key. Valid until the key is set again or erased here.
  const Value* find(const Key& key) const {
    const Node* node = find_node(root_.get(), key);
    return node ? &node->entry->value : nullptr;
  }
  bool has(const Key& key) const { return find(key) != nullptr; }
  /// Inserts the key or replaces its value.
  void set(const Key& key, Value value) {
    root_ = inserted(root_, std::make_shared<const Entry>(Entry{key, std::move(value)}), priority(key));
  }
  void erase(const Key& key) {
    if (has(key)) root_ = erased(root_, key);
  }
  /// f(key, value) in the order of keys.
  template <class F>
  void each(F f) const {
    visit(root_.get(), f);
  }
  /// f(key, value here or nullptr, value there) for what is not the same entry in `there`; most of what both
  /// share is never looked at. f must not change this map.
  template <class F>
  void differences(const SharedMap& there, F f) const {
    compare(there.root_.get(), f);
  }

 private:
  struct Entry {
    Key key;
    Value value;
  };
  struct Node;
  using Link = std::shared_ptr<const Node>;
  struct Node {
    std::shared_ptr<const Entry> entry;
    std::uint64_t priority;  ///< not below those of its children
    Link left, right;
  };

  /// Any bits that look random keep the tree flat; its shape changes no result.
  static std::uint64_t priority(const Key& key) {
    std::uint64_t bits = std::hash<Key>{}(key) + 0x9E3779B97F4A7C15u;
    for (int i = 0; i < 2; ++i) bits = (bits ^ (bits >> 32)) * 0xD6E8FEB86659FD93u;
    return bits;
  }
  static Link node(const Node& like, Link left, Link right) {
    return std::make_shared<const Node>(Node{like.entry, like.priority, std::move(left), std::move(right)});
  }
  static const Node* find_node(const Node* at, const Key& key) {
    while (at && at->entry->key != key) at = (key < at->entry->key ? at->left : at->right).get();
    return at;
  }
  static Link inserted(const Link& at, const std::shared_ptr<const Entry>& entry, std::uint64_t priority) {
    if (!at) return std::make_shared<const Node>(Node{entry, priority, nullptr, nullptr});
    if (entry->key == at->entry->key) return std::make_shared<const Node>(Node{entry, priority, at->left, at->right});
    if (entry->key < at->entry->key) {
      const Link left = inserted(at->left, entry, priority);
      return left->priority > at->priority ? node(*left, left->left, node(*at, left->right, at->right))
                                           : node(*at, left, at->right);
    }
    const Link right = inserted(at->right, entry, priority);
    return right->priority > at->priority ? node(*right, node(*at, at->left, right->left), right->right)
                                          : node(*at, at->left, right);
  }
  static Link erased(const Link& at, const Key& key) {
    if (at->entry->key == key) return joined(at->left, at->right);
    return key < at->entry->key ? node(*at, erased(at->left, key), at->right)
                                : node(*at, at->left, erased(at->right, key));
  }
  static Link joined(const Link& a, const Link& b) {
    if (!a || !b) return a ? a : b;
    return a->priority > b->priority ? node(*a, a->left, joined(a->right, b)) : node(*b, joined(a, b->left), b->right);
  }
  template <class F>
  static void visit(const Node* at, F& f) {
    if (!at) return;
    visit(at->left.get(), f);
    f(at->entry->key, at->entry->value);
    visit(at->right.get(), f);
  }
  template <class F>
  void compare(const Node* there, F& f) const {
    if (!there) return;
    const Node* here = find_node(root_.get(), there->entry->key);
    if (here == there) return;  // and so all below it
    compare(there->left.get(), f);
    if (!here || here->entry != there->entry)
      f(there->entry->key, here ? &here->entry->value : nullptr, there->entry->value);
    compare(there->right.get(), f);
  }

  Link root_;
};

}  // namespace abbe::lang
