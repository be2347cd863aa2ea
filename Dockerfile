# The testbed, built on Debian 12: docker build -t gradslc . && docker run --rm gradslc list
FROM debian:12
WORKDIR /gradslc
COPY scripts/setup scripts/setup
RUN scripts/setup && rm -rf /var/lib/apt/lists/*
COPY . .
ENV GRADSLC_CMAKE_ARGS="-DGRADSLC_TESTS=OFF -DGRADSLC_BENCHMARKS=OFF"
RUN scripts/build
ENTRYPOINT ["/gradslc/build/gradslc"]
