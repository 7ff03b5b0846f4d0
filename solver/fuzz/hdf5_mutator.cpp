// A mutator for libFuzzer that knows HDF5: what it changes gets its checksums again, so that the readers
// behind the library's first look are reached. Format: HDF5 File Format Specification 3.0, II.A (superblock),
// IV.A.1.b (object headers).
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <string_view>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed);

namespace {

using Bytes = std::span<std::uint8_t>;

/// Jenkins' lookup3, hashlittle() with initial value 0: the checksum of HDF5's metadata.
std::uint32_t checksum(std::span<const std::uint8_t> key) {
    std::uint32_t a = 0xdeadbeef + static_cast<std::uint32_t>(key.size());
    std::uint32_t b = a;
    std::uint32_t c = a;
    const auto add = [&](std::size_t count) { // of at most 12 bytes
        std::array<std::uint8_t, 12> block{};
        std::copy_n(key.begin(), count, block.begin());
        std::array<std::uint32_t, 3> words{};
        std::memcpy(words.data(), block.data(), block.size());
        a += words[0];
        b += words[1];
        c += words[2];
        key = key.subspan(count);
    };
    while (key.size() > 12) {
        add(12);
        a -= c, a ^= std::rotl(c, 4), c += b;
        b -= a, b ^= std::rotl(a, 6), a += c;
        c -= b, c ^= std::rotl(b, 8), b += a;
        a -= c, a ^= std::rotl(c, 16), c += b;
        b -= a, b ^= std::rotl(a, 19), a += c;
        c -= b, c ^= std::rotl(b, 4), b += a;
    }
    if (key.empty()) {
        return c;
    }
    add(key.size());
    c ^= b, c -= std::rotl(b, 14);
    a ^= c, a -= std::rotl(c, 11);
    b ^= a, b -= std::rotl(a, 25);
    c ^= b, c -= std::rotl(b, 16);
    a ^= c, a -= std::rotl(c, 4);
    b ^= a, b -= std::rotl(a, 14);
    c ^= b, c -= std::rotl(b, 24);
    return c;
}

std::uint64_t little_endian(Bytes bytes) {
    std::uint64_t value = 0;
    for (std::size_t k = std::min<std::size_t>(bytes.size(), 8); k > 0; --k) {
        value = value << 8 | bytes[k - 1];
    }
    return value;
}

/// A piece of metadata with its checksum in the last four bytes.
struct Block {
    std::size_t begin;
    std::size_t size;
};

/// The continuations that the messages of an object header name.
void add_continuations(Bytes file, std::size_t begin, std::size_t end, bool ordered,
                       std::vector<Block>& blocks) {
    const std::size_t head = ordered ? 6 : 4;
    for (std::size_t at = begin; at + head <= end;) {
        const std::size_t size = little_endian(file.subspan(at + 1, 2));
        if (file[at] == 0x10 && at + head + 16 <= end) {
            const std::uint64_t address = little_endian(file.subspan(at + head, 8));
            const std::uint64_t length = little_endian(file.subspan(at + head + 8, 8));
            if (length >= 8 && length <= file.size() && address <= file.size() - length &&
                blocks.size() < 1000) {
                blocks.push_back({address, length});
                add_continuations(file, address + 4, address + length - 4, ordered, blocks);
            }
        }
        at += head + size;
    }
}

/// Superblock and object headers, with their continuations.
std::vector<Block> blocks_of(Bytes file) {
    std::vector<Block> blocks;
    constexpr std::size_t superblock = 48;
    if (file.size() >= superblock && file[8] >= 2) {
        blocks.push_back({0, superblock});
    }
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    for (std::size_t at = text.find("OHDR\2"); at != std::string_view::npos;
         at = text.find("OHDR\2", at + 1)) {
        if (at + 6 >= file.size()) {
            break;
        }
        const unsigned flags = file[at + 5];
        const std::size_t width = std::size_t{1} << (flags & 3U);
        const std::size_t head = 6 + ((flags & 0x20U) != 0 ? 16 : 0) + ((flags & 0x10U) != 0 ? 4 : 0);
        if (at + head + width > file.size()) {
            continue;
        }
        const std::uint64_t chunk = little_endian(file.subspan(at + head, width));
        const std::size_t begin = at + head + width;
        if (chunk <= file.size() && begin + chunk + 4 <= file.size()) {
            blocks.push_back({at, head + width + chunk + 4});
            add_continuations(file, begin, begin + chunk, (flags & 4U) != 0, blocks);
        }
    }
    return blocks;
}

/// One to four values in one block become others, of which small and extreme ones are likelier.
void change_block(Bytes block, std::minstd_rand& engine) {
    constexpr std::array<std::uint64_t, 10> telling{0,      1,          0x7F,       0xFF,      0x7FFF,
                                                    0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF, INT64_MAX, UINT64_MAX};
    for (unsigned changes = 1 + engine() % 4; changes > 0; --changes) {
        const std::size_t at = engine() % block.size();
        const std::size_t width = std::min<std::size_t>(std::size_t{1} << engine() % 4, block.size() - at);
        std::uint64_t value = little_endian(block.subspan(at, width));
        switch (engine() % 4) {
        case 0:
            value = telling[engine() % telling.size()];
            break;
        case 1:
            value ^= std::uint64_t{1} << engine() % (8 * width);
            break;
        case 2:
            value += engine() % 17 - 8;
            break;
        default:
            value = engine();
        }
        for (std::size_t k = 0; k < width; ++k) {
            block[at + k] = static_cast<std::uint8_t>(value >> 8 * k);
        }
    }
}

} // namespace

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    std::minstd_rand engine(seed);
    if (size < 8 || std::memcmp(data, "\x89HDF\r\n\x1a\n", 8) != 0) {
        return LLVMFuzzerMutate(data, size, most); // text, or already no HDF5
    }
    const std::vector<Block> before = blocks_of({data, size});
    if (before.empty() || engine() % 8 == 0) {
        size = LLVMFuzzerMutate(data, size, most);
    } else if (engine() % 4 == 0) {
        change_block({data, size}, engine); // heaps and data, too
    } else {
        const Block block = before[engine() % before.size()];
        change_block({data + block.begin, block.size}, engine);
    }
    if (engine() % 16 == 0) {
        return size; // now and then wrong checksums
    }
    // Where the blocks begin is taken from before the change as well: it may have been in a length.
    for (const std::vector<Block>& blocks : {before, blocks_of({data, size})}) {
        for (const Block& block : blocks) {
            if (block.begin + block.size <= size) {
                const std::uint32_t sum = checksum({data + block.begin, block.size - 4});
                std::memcpy(data + block.begin + block.size - 4, &sum, sizeof sum);
            }
        }
    }
    return size;
}
