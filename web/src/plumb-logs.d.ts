// The program that Emscripten makes of web/logs; build.mjs says where it is.
declare module "plumb-logs" {
  export default function createPlumb(settings: Record<string, unknown>): Promise<never>;
}
