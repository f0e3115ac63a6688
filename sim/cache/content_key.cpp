#include "sim/cache/content_key.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <stdexcept>

namespace groundloop::sim {

std::string ContentKey::hex() const {
  std::string text;
  for (const uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

struct KeyBuilder::Impl {
  Impl() : context(EVP_MD_CTX_new(), EVP_MD_CTX_free) {}
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context;
};

KeyBuilder::KeyBuilder() : impl_(std::make_unique<Impl>()) {
  if (EVP_DigestInit_ex(impl_->context.get(), EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("OpenSSL gives no SHA-256");
  }
}

KeyBuilder::KeyBuilder(const KeyBuilder& other) : impl_(std::make_unique<Impl>()) {
  EVP_MD_CTX_copy_ex(impl_->context.get(), other.impl_->context.get());
}

KeyBuilder::~KeyBuilder() = default;

void KeyBuilder::add(std::string_view text) {
  add(static_cast<uint64_t>(text.size()));
  add_bytes(text.data(), text.size());
}

void KeyBuilder::add_bytes(const void* data, size_t size) {
  EVP_DigestUpdate(impl_->context.get(), data, size);
}

ContentKey KeyBuilder::key() const {
  const KeyBuilder copy(*this);
  ContentKey key;
  EVP_DigestFinal_ex(copy.impl_->context.get(), key.bytes.data(), nullptr);
  return key;
}

}  // namespace groundloop::sim
