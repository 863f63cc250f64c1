"""An environment in the manner of gymnasium: a policy moves the tool and presses the ball as hard as asked.

    PYTHONPATH=python python3 examples/policy.py
"""
import encounter


class PressEnv:
    """Observation: height of the tool's tip, mm, and the felt force, N. Action: the height to aim at, mm. Reward: nearness to
    the wanted force."""

    def __init__(self, scene="tennis_ball", wanted_N=2.0, length_s=8.0):
        self.scene, self.wanted_N, self.length_s, self.world = scene, wanted_N, length_s, None

    def reset(self, seed=1):
        self.close()
        self.world = encounter.serve(self.scene, seed=seed, every_ms=20)
        return self._observed(self.world.row), {}

    def step(self, action):
        row = self.world.step([0.0, 0.0, action])
        height, force = self._observed(row)
        return (height, force), -abs(force - self.wanted_N), False, row["time_s"] >= self.length_s, {"mode": row["mode"]}

    def close(self):
        if self.world is not None:
            self.world.close()

    @staticmethod
    def _observed(row):
        return row["true_tool_z_mm"], max(row["force_N"], 0.0) if row["mode"] == "contact" else 0.0


def press(env, seed=1):
    """The policy: lowers the tool to the ball, then aims higher or lower by the error of the force. Returns the last force, N."""
    (height, force), _ = env.reset(seed)
    aim, truncated = height, False
    while not truncated:
        aim = aim - 0.6 if force == 0.0 else min(aim, height) + 0.2 * (force - env.wanted_N)
        (height, force), _, _, truncated, _ = env.step(aim)
    env.close()
    return force


if __name__ == "__main__":
    print(f"{press(PressEnv()):.2f} N")
