// Fuzz the circuits of one type on one bus: `fuzz TABLE SEED FIRST PACKETS CIRCUIT...`.
//
// FIRST is the number of the first packet; its episode begins there or before. A line of JSON for
// each circuit tells what was done, or which rule was broken.

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>

#include "bench.h"

namespace {

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (char each : text) {
        if (each == '"' || each == '\\') out += '\\';
        out += each;
    }
    return out + '"';
}

void print_counts(const Bench& bench, double seconds) {
    const Counts& counts = bench.counts;
    const Tally& tally = bench.tally();
    std::cout << "\"packets\": " << counts.packets << ", \"bad\": " << counts.bad
              << ", \"discarded\": " << counts.discarded << ", \"resets\": " << counts.resets
              << ", \"cycles\": " << counts.cycles << ", \"transfers\": " << tally.transfers
              << ", \"seconds\": " << seconds << ", \"statuses\": {";
    const char* comma = "";
    for (int status = 0; status <= OVERRUN; ++status) {
        if (!tally.statuses[status]) continue;
        std::cout << comma << quoted(name_of(status)) << ": " << tally.statuses[status];
        comma = ", ";
    }
    std::cout << "}, \"damages\": {";
    for (size_t n = 0; n < DAMAGE_NAMES.size(); ++n)
        std::cout << (n ? ", " : "") << quoted(DAMAGE_NAMES[n]) << ": " << counts.damages[n];
    std::cout << "}";
}

void print_failure(const Bench& bench, const Broken& broken) {
    const Bytes* bytes = bench.bytes_of(broken.packet);
    std::cout << ", \"failure\": {\"rule\": " << quoted(broken.what())
              << ", \"packet\": " << broken.packet
              << ", \"hex\": " << quoted(bytes ? hex(*bytes) : "")
              << ", \"expected\": " << quoted(broken.expected)
              << ", \"came\": " << quoted(broken.came) << ", \"cycle\": " << bench.cycle()
              << "}";
}

void run(Circuit& circuit, const Table& table, uint64_t seed, uint64_t first, uint64_t packets) {
    Bench bench(circuit, table, seed);
    // Processor time: other programs do not count.
    const std::clock_t start = std::clock();
    const auto seconds = [&] { return double(std::clock() - start) / CLOCKS_PER_SEC; };
    std::cout << "{\"circuit\": " << quoted(circuit.name) << ", ";
    try {
        const uint64_t begin = first / Bench::EPISODE;
        const uint64_t end = (first + packets + Bench::EPISODE - 1) / Bench::EPISODE;
        for (uint64_t episode = begin; episode < end; ++episode) bench.run(episode);
        print_counts(bench, seconds());
    } catch (const Broken& broken) {
        print_counts(bench, seconds());
        print_failure(bench, broken);
    }
    std::cout << "}" << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 6) {
        std::fprintf(stderr, "usage: fuzz TABLE SEED FIRST PACKETS CIRCUIT...\n");
        return 2;
    }
    std::ifstream text(argv[1]);
    const Table table = read_table(text);
    const uint64_t seed = std::strtoull(argv[2], nullptr, 10);
    const uint64_t first = std::strtoull(argv[3], nullptr, 10);
    const uint64_t packets = std::strtoull(argv[4], nullptr, 10);
    for (Circuit* circuit : make_circuits())
        for (int n = 5; n < argc; ++n)
            if (circuit->name == argv[n]) run(*circuit, table, seed, first, packets);
    return 0;
}
