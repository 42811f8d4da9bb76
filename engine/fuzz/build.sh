#!/bin/sh
# Builds the fuzz target into the folder given, with sanitizers where they link: with a driver of
# pseudo-random bytes, or, by clang, with libFuzzer, which learns what bytes reach something new.
#   make fuzz
#   sh engine/fuzz/build.sh build/libfuzzer libFuzzer && build/libfuzzer/engines -max_total_time=600
set -eu
cd "$(dirname "$0")/../.."
to=${1:?give a folder}
mkdir -p "$to"
rm -f "$to"/*.o
if [ "${2:-}" = libFuzzer ]; then
    cc=clang cxx=clang++ driver="-fsanitize=fuzzer" checks="-fsanitize=fuzzer-no-link,address,undefined"
else
    cc=${CC:-cc} cxx=${CXX:-c++} driver=engine/fuzz/driver.cpp checks="-fsanitize=address,undefined"
    if ! echo 'int main() { return 0; }' | $cxx $checks -x c++ -o "$to/links" - 2>"$to/links.log"; then
        echo "no sanitizers: $cxx cannot link $checks" >&2
        checks=""
    fi
fi
[ -z "$checks" ] || checks="$checks -fno-sanitize-recover=all -fno-omit-frame-pointer"
common="-g -O1 -ffp-contract=off -Icore/include $checks"
strict="$common -std=c++17"
case $(uname -m) in x86_64 | amd64 | AMD64) strict="$strict -DHYST_X86" sets="baseline avx2 avx512" ;; *) sets=baseline ;; esac

# As CMakeLists.txt has it: sums over samples may be contracted, nothing else.
for set in $sets; do
    case $set in
    avx2) flags="-mavx2 -mfma" ;;
    avx512) flags="-mavx512f -mavx512dq -mavx512vl -mfma" ;;
    *) flags="" ;;
    esac
    kernels="$strict -Wno-psabi -DHYST_INSTRUCTION_SET=$set $flags"
    $cxx $kernels -c engine/simd/exact_kernels.cpp -o "$to/exact_$set.o"
    $cxx $kernels -ffp-contract=fast -c engine/simd/sum_kernels.cpp -o "$to/sum_$set.o"
done
while read -r source; do
    $cc -std=c99 $common -c "core/$source" -o "$to/core_$(basename "$source" .c).o"
done < core/SOURCES
for source in engine/simd/kernels.cpp engine/*.cpp engine/records/*.cpp engine/tasks/*.cpp \
    engine/kinds/*.cpp engine/kinds/fast/*.cpp engine/dual/derivative.cpp; do
    $cxx $strict -c "$source" -o "$to/$(echo "$source" | tr / _).o"
done
# The kernel's own derivative, as engine/dual/CMakeLists.txt has it; to follow every tangent for a
# debugger would take the compiler minutes a file.
sed -n 's/^const hyst_kind \(hyst_[a-z_]*\) = .*/\&\1,/p' core/src/*.c | tr '\n' ' ' > "$to/all_kinds"
grep -l '^const hyst_kind hyst_' core/src/*.c | sed 's|core/src/\(.*\)|#include "\1"|' \
    > "$to/core_kinds.inc"
echo "#define HYST_ALL_KINDS $(cat "$to/all_kinds")" >> "$to/core_kinds.inc"
ls engine/kinds/*.cpp | sed 's|engine/\(.*\)|#include "\1"|' > "$to/kinds.inc"
ls engine/dual/rules/*.hpp | sed 's|engine/\(.*\)|#include "\1"|' > "$to/rules.inc"
tangents() {
    source=$1 count=$2 name=tangents_$3
    shift 3
    $cxx $strict -g0 -Wno-psabi -Icore/src -Iengine -I"$to" -DHYST_TANGENTS="$count" \
        -DHYST_KINDS="$name" "$@" -c "engine/dual/$source.cpp" -o "$to/$name.o"
}
tangents reverse 1 taped -DHYST_TAPE
for count in 4 8 16; do
    tangents stages $count $count
    tangents pass $count ${count}_avx2 -mavx2 -mfma
    tangents pass $count ${count}_avx512 -mavx512f -mavx512dq -mavx512vl -mfma
done
$cxx $strict $driver engine/fuzz/engines.cpp "$to"/*.o -lpthread -o "$to/engines"
